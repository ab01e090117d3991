#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "command/look/domain_picture.hpp"
#include "command/top/sampler.hpp"
#include "designer_state.idl.hpp"
#include "plan.hpp"
#include "skein/introspection.idl.hpp"
#include "skein/mission_status.idl.hpp"

namespace skein::command::designer {

/// A domain at one moment.
struct Observation {
  std::uint64_t time = 0;  ///< Nanoseconds by a clock that is never set.
  DomainPicture picture;   ///< Whole.
  std::vector<introspection::ServiceStatistics> statistics;
  std::vector<launch::MissionStatus> missions;       ///< As DomainState has them.
  std::set<std::uint32_t> stopped{};                 ///< Those of their processes that are stopped.
  std::vector<introspection::Decision> decisions{};  ///< The latest of each Head and service.
  std::uint64_t wall_time = 0;                       ///< Of now, as Decision::time.
};

/// Makes the entities and links of a state from one sight after the other: rates come of two, and
/// entities that have gone are remembered for a while. Knows no network. Not thread-safe.
class StateMaker {
 public:
  /// For how long an entity is shown that nobody expects, after it has gone, in nanoseconds.
  static constexpr std::uint64_t kRemembered = 60'000'000'000;

  explicit StateMaker(std::optional<Plan> plan = {}) : plan_(std::move(plan)) {}

  /// Entities by name, without their places, and links.
  DomainState make(const Observation& sight);

 private:
  struct Known {
    EntityState state;
    std::uint64_t seen = 0;
    int silent_looks = 0;
  };

  std::set<std::string> names(const Observation& sight) const;
  void remember(const Observation& sight, std::map<std::string, EntityState>& entities);

  const std::optional<Plan> plan_;
  top::Rates rates_;
  std::map<std::string, Known> known_;                  // by the entity's name
  std::map<std::string, std::uint64_t> counts_before_;  // calls and values of links
  std::uint64_t time_before_ = 0;                       // of the last sight; 0: there was none
};

/// The short form for the page.
DecisionNote note_of(const introspection::Decision& decision);
LogNote note_of(const introspection::LogLine& line);
LogNote note_of(const launch::MissionLine& line, const std::string& mission);

}  // namespace skein::command::designer
