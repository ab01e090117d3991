#include "navigation/terrain/degree_tile.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "skein/error.hpp"

namespace skein::navigation {
namespace {

constexpr double kMetresPerDegree = 6371008.8 * std::numbers::pi / 180;

/// Collects the void that `seed` belongs to, fills it, and leaves the rest alone.
void fill_void(std::vector<float>& heights, std::size_t width, std::size_t seed,
               const std::filesystem::path& file) {
  std::vector<std::size_t> region{seed};
  float highest = kVoidPost;
  heights[seed] = std::numeric_limits<float>::quiet_NaN();
  for (std::size_t next = 0; next < region.size(); ++next) {
    const std::size_t post = region[next];
    const auto look_at = [&](bool exists, std::size_t neighbour) {
      if (!exists || std::isnan(heights[neighbour])) return;
      if (heights[neighbour] == kVoidPost) {
        heights[neighbour] = std::numeric_limits<float>::quiet_NaN();
        region.push_back(neighbour);
      } else {
        highest = std::max(highest, heights[neighbour]);
      }
    };
    look_at(post % width > 0, post - 1);
    look_at(post % width + 1 < width, post + 1);
    look_at(post >= width, post - width);
    look_at(post + width < heights.size(), post + width);
  }
  if (highest == kVoidPost) refuse(file, "holds no data at all, only voids");
  for (const std::size_t post : region) heights[post] = highest;
}

}  // namespace

void refuse(const std::filesystem::path& file, const std::string& why) {
  throw InvalidArgument(fmt::format("{}: {}", file.string(), why));
}

void require_earthly(const std::filesystem::path& file, int height_m, const std::string& where) {
  if (height_m >= -500 && height_m <= 9000) return;
  refuse(file,
         fmt::format("has a height of {} m in {}; the heights of the earth are between -500 m "
                     "and 9000 m",
                     height_m, where));
}

Terrain lay_out_tile(const std::filesystem::path& file, int southern_latitude_deg, int rows,
                     int columns, std::vector<float> heights_m) {
  for (std::size_t post = 0; post < heights_m.size(); ++post) {
    if (heights_m[post] != kVoidPost) continue;
    fill_void(heights_m, static_cast<std::size_t>(columns), post, file);
  }
  const double middle = (southern_latitude_deg + 0.5) * std::numbers::pi / 180;
  return Terrain(file.string(), rows, columns, kMetresPerDegree / (rows - 1),
                 kMetresPerDegree * std::cos(middle) / (columns - 1), std::move(heights_m));
}

}  // namespace skein::navigation
