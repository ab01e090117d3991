#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "navigation/grid/grid_map.hpp"

namespace skein::navigation::grid {

/// A task with a known result.
struct Scenario {
  Cell start;
  Cell goal;
  /// Of the shortest path on the grid; empty where it is recorded that there is none.
  std::optional<double> length;
};

/// How far a length may be from the recorded one, which has six digits.
constexpr double kRecordedPrecision = 0.01;

/// The tasks of a `.scen` (plane) or `.3dscen` (space) file of movingai.com for `map`. On a plane,
/// a recorded length of 0 between different cells means that there is no path. Throws
/// InvalidArgument with file, line and reason, also where a task leaves the map or is meant for a
/// map of other size.
std::vector<Scenario> read_scenarios(const std::filesystem::path& file, const GridMap& map);

/// Whether `length` (empty: no path) is the recorded result.
bool is_recorded_result(const Scenario& scenario, std::optional<double> length);

}  // namespace skein::navigation::grid
