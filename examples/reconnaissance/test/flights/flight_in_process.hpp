#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "mission/profile/mission_profile.hpp"

namespace reconnaissance {

/// What came of a flight.
struct Outcome {
  int exit_code = -1;     ///< Of the ground station; -1: the flight never ended.
  nlohmann::json report;  ///< As the ground station has written it.
  std::string log;        ///< What the entities have printed.
  std::string tracks;     ///< The tracks of the first aircraft.

  /// Why the flight has not passed, in the report's words; empty if it has.
  std::string reason() const;
};

/// Flies a mission in this process: each peer of the profile is an entity on a network of its own,
/// and one thread makes the mission's time. The same profile, variables and seed fly the same
/// flight. `settings` are those of `skein launch --set`. Not for two threads at once.
Outcome fly(const std::string& profile, const skein::profile::VariableValues& variables,
            const std::vector<std::string>& settings = {});

}  // namespace reconnaissance
