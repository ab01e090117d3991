#pragma once

#include <vector>

#include "geodesy/local_frame.hpp"

namespace reconnaissance {

/// A way of two points or more, as an aircraft can fly it that begins on a course and has to be on
/// another one at the end: what turns it takes is inserted, as corners of the shortest ways (see
/// dubins_corners()) from its beginning and to its end. The points of the way within two turning
/// circles of an end give way to them. Heights grow evenly between the points that stay.
/// `first_quarters`: so many quarters of a circle are turned before, to the right; negative: left.
std::vector<Local> with_turns(const std::vector<Local>& way, double begin_course_rad,
                              double end_course_rad, double radius_m, int first_quarters = 0);

}  // namespace reconnaissance
