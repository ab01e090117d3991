#pragma once

#include <list>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "navigation/route_checker/height_grid.hpp"
#include "navigation/terrain/terrain_provider.hpp"
#include "navigator.idl.hpp"
#include "test/connector/pairing.hpp"
#include "test/tools/child_process.hpp"

namespace skein::test {

/// What a planner's description declares.
struct Declared {
  int latency_ms;
  double quality;
};

/// A navigator in this process, on one vendor, and its planners in processes of their own, on the
/// other, to be killed, stopped and lied to by. Who was silent for a minute is still trusted: what
/// is noticed here is noticed by other means.
class PlanningStage {
 public:
  explicit PlanningStage(HeadOptions head = {});
  ~PlanningStage();

  /// Starts a planner and has it plan once, so that it knows the terrain.
  ChildProcess& add(const std::string& name, const std::string& kind, Declared declared);
  /// The command line of such a process, for whoever starts it in our place.
  std::vector<std::string> command(const std::string& name, const std::string& kind,
                                   Declared declared, int seed = 1) const;
  bool is_available(const std::string& name) const;
  void await(const std::string& name) const;

  struct Answer {
    std::optional<AE_navigator::Route> route;
    bool proven = false;    ///< Where there is no route.
    std::string refusal{};  ///< Why.
    Duration took{};
    AE_navigatorI::PlanningReport report;
    /// Of the planner's last attempt, or nothing.
    std::string outcome_of(const std::string& planner) const;
    const AE_navigatorI::PlannerCandidate& candidate(const std::string& planner) const;
  };
  /// Asks for a route; the call ends after `budget`. Refusals, and the caller's own time-out, are
  /// answers.
  Answer ask(Duration budget, const std::string& planner = "");
  /// As above; `meanwhile` runs as soon as that planner is at work.
  template <class Action>
  Answer ask_while(Duration budget, ChildProcess& planner, Action meanwhile) {
    auto call = begin(budget, "");
    await_work_of(planner);
    meanwhile();
    return end(std::move(call));
  }

  /// Whether the route checker finds nothing wrong with it.
  bool valid(const Answer& answer) const;

  Entity& navigator() { return *navigator_; }
  AE_navigator::Problem problem;

 private:
  struct Asked {
    std::string id;
    Instant begin;
    Call<AE_navigator::Route> call;
  };
  Asked begin(Duration budget, const std::string& planner);
  Answer end(Asked asked);
  void await_work_of(ChildProcess& planner);

  std::shared_ptr<navigation::TerrainProvider> terrains_;
  navigation::HeightGrid ground_;
  std::unique_ptr<Entity> navigator_;
  std::unique_ptr<Entity> client_;
  std::optional<AE_navigatorI::INavigator::Proxy> proxy_;
  std::list<ChildProcess> planners_;
  int asked_ = 0;
};

}  // namespace skein::test
