#include <fmt/core.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <numbers>
#include <regex>

#include "skein/core/error.hpp"
#include "skein/navigation/terrain.hpp"

namespace skein::navigation {
namespace {

constexpr float kVoid = -32768;
constexpr double kMetresPerDegree = 6371008.8 * std::numbers::pi / 180;

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& why) {
  throw InvalidArgument(fmt::format("{}: {}", file.string(), why));
}

/// Latitude of the southern edge in degrees, from a name such as `S07W123.hgt`.
int southern_latitude(const std::filesystem::path& file) {
  static const std::regex kName(R"(([NS])(\d\d)[EW]\d\d\d\.hgt)", std::regex::icase);
  std::smatch match;
  const std::string name = file.filename().string();
  if (!std::regex_match(name, match, kName)) {
    refuse(file, "the name does not say where the tile lies; it must be like N53E027.hgt");
  }
  const int degrees = std::atoi(match[2].str().c_str());
  const int latitude = match[1] == "S" || match[1] == "s" ? -degrees : degrees;
  if (latitude < -90 || latitude > 89) refuse(file, "there is no such latitude");
  return latitude;
}

int posts_per_side(const std::filesystem::path& file) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error) refuse(file, "cannot be read: " + error.message());
  for (const int side : {1201, 3601}) {
    if (size == 2U * static_cast<std::uintmax_t>(side) * static_cast<std::uintmax_t>(side)) {
      return side;
    }
  }
  refuse(file, fmt::format("has {} bytes; an SRTM tile has 2884802 (1201 x 1201 posts) or 25934402 "
                           "(3601 x 3601); the file is cut off or something else",
                           size));
}

std::vector<float> read_posts(const std::filesystem::path& file, int side) {
  const std::size_t width = static_cast<std::size_t>(side);
  std::vector<unsigned char> bytes(2 * width * width);
  std::ifstream in(file, std::ios::binary);
  if (!in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()))) {
    refuse(file, "cannot be read to its end");
  }
  std::vector<float> heights(width * width);
  for (std::size_t row = 0; row < width; ++row) {
    for (std::size_t column = 0; column < width; ++column) {
      const std::size_t from = 2 * (row * width + column);
      const auto value = static_cast<std::int16_t>((bytes[from] << 8) | bytes[from + 1]);
      if (value != kVoid && (value < -500 || value > 9000)) {
        refuse(file, fmt::format("has a height of {} m in row {}, column {}; the heights of the "
                                 "earth are between -500 m and 9000 m",
                                 value, row + 1, column + 1));
      }
      heights[(width - 1 - row) * width + column] = value;
    }
  }
  return heights;
}

/// Collects the void that `seed` belongs to, fills it, and leaves the rest alone.
void fill_void(std::vector<float>& heights, std::size_t width, std::size_t seed,
               const std::filesystem::path& file) {
  std::vector<std::size_t> region{seed};
  float highest = kVoid;
  heights[seed] = std::numeric_limits<float>::quiet_NaN();
  for (std::size_t next = 0; next < region.size(); ++next) {
    const std::size_t post = region[next];
    const auto look_at = [&](bool exists, std::size_t neighbour) {
      if (!exists || std::isnan(heights[neighbour])) return;
      if (heights[neighbour] == kVoid) {
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
  if (highest == kVoid) refuse(file, "holds no data at all, only voids");
  for (const std::size_t post : region) heights[post] = highest;
}

}  // namespace

Terrain read_hgt(const std::filesystem::path& file) {
  const int latitude = southern_latitude(file);
  const int side = posts_per_side(file);
  std::vector<float> heights = read_posts(file, side);
  for (std::size_t post = 0; post < heights.size(); ++post) {
    if (heights[post] == kVoid) fill_void(heights, static_cast<std::size_t>(side), post, file);
  }
  const double north_spacing = kMetresPerDegree / (side - 1);
  const double middle = (latitude + 0.5) * std::numbers::pi / 180;
  return Terrain(file.string(), side, side, north_spacing, north_spacing * std::cos(middle),
                 std::move(heights));
}

}  // namespace skein::navigation
