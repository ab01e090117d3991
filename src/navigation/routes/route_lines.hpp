#pragma once

#include <span>
#include <string>
#include <vector>

namespace skein::navigation {

/// A point of the picture.
struct PicturePoint {
  double x = 0;
  double y = 0;
};

/// What is to be drawn of each line, as the `d` of an SVG path, so that none hides another: where
/// several run together, dashes of each take turns.
std::vector<std::string> lines_side_by_side(std::span<const std::vector<PicturePoint>> lines);

}  // namespace skein::navigation
