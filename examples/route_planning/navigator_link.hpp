#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "navigator.idl.hpp"
#include "skein/entity.hpp"

namespace route_planning {

struct Question {
  std::string id;
  AE_navigator::Problem problem;
  skein::Duration time_to_think;
  /// How often to ask again where the answer comes too late; short times miss on a busy machine.
  int repetitions = 0;
};

struct Answer {
  std::optional<AE_navigator::Route> route;
  /// Without a route: why, and whether it is proved that there is none.
  std::string refusal;
  bool proven = false;
  skein::Duration took{};
  int times_asked = 1;
  /// How the navigator decided; of the last time that it was asked.
  AE_navigatorI::PlanningReport report;
};

/// A planner that was killed while it planned.
struct Kill {
  std::string planner;
  std::uint32_t pid = 0;
  skein::Duration planned_for{};
  skein::Instant at{};
};

/// The ground station's side of its conversation with the navigator.
class NavigatorLink {
 public:
  /// Waits for the navigator. Throws Unavailable, with the reason, where it does not appear.
  explicit NavigatorLink(skein::Entity& entity);

  /// Leaves the session with the navigator's Head and opens one that selects planners by that
  /// strategy.
  void select_by(const std::string& strategy);

  /// Has that planner plan once without a hurry, so that it knows the terrain. Waits until the
  /// planner is available; throws Unavailable where it is not in 20 s.
  void brief(const std::string& planner, AE_navigator::Problem problem);

  /// Briefs it, and has it plan once more, a quick one often, so that the navigator knows what it
  /// takes where it knows the terrain.
  void train(const std::string& planner, AE_navigator::Problem problem);

  /// Asks for a route. Throws what the navigator throws apart from its refusals.
  Answer ask(const Question& question);

  /// Asks, looks which planner works on it, and kills that planner's process with SIGKILL. Throws
  /// InvalidArgument where it may not be killed: it shares the navigator's process, or another
  /// host.
  Answer ask_and_kill(const Question& question, Kill& kill);

 private:
  Answer ask_once(const Question& question);
  /// Has it plan once; false where it is not available.
  bool practise(const std::string& planner, const AE_navigator::Problem& problem);
  AE_navigatorI::PlanningReport report_of(const Question& question);
  /// Waits for a planner that is at work for some time.
  AE_navigatorI::PlanningStatus await_planner(skein::Instant deadline);
  void require_killable(const AE_navigatorI::PlanningStatus& status);

  skein::Entity& entity_;
  AE_navigatorI::INavigator::Proxy navigator_;
};

}  // namespace route_planning
