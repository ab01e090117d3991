#pragma once

#include <functional>
#include <string>
#include <vector>

#include "report/record.hpp"

namespace reconnaissance {

/// One line: verdict, duration, distance, targets, exposure, misses. Misses are decisions for which
/// somebody did not answer in time, and samples of sensors that did not arrive.
std::string headline(const MissionRecord& record);

/// What was unusual, in the order of time: what the record has, conditions that are not kept,
/// faults, decisions without a result or in which somebody failed.
std::vector<Flag> flags_of(const MissionRecord& record);

/// Ground around all that the record shows, some `columns` wide; `height_m` is asked for metres
/// north and east of the origin.
GroundGrid ground_around(const MissionRecord& record, std::size_t columns,
                         const std::function<double(double north_m, double east_m)>& height_m);

/// All of it for programs: metres, seconds, degrees. Text that is not UTF-8 is shown as such. What
/// is no number becomes null.
std::string to_json(const MissionRecord& record);

/// All of it for people, as one page that refers to nothing outside of itself.
std::string to_html(const MissionRecord& record);

}  // namespace reconnaissance
