#include <fmt/core.h>

#include <cstdlib>
#include <fstream>
#include <regex>

#include "navigation/terrain/degree_tile.hpp"

namespace skein::navigation {
namespace {

struct Corner {
  int latitude_deg;
  int longitude_deg;
};

/// The south-west corner, from a name such as `S07W123.hgt`.
Corner south_west_corner(const std::filesystem::path& file) {
  static const std::regex kName(R"(([NS])(\d\d)([EW])(\d\d\d)\.hgt)", std::regex::icase);
  std::smatch match;
  const std::string name = file.filename().string();
  if (!std::regex_match(name, match, kName)) {
    refuse(file, "the name does not say where the tile lies; it must be like N53E027.hgt");
  }
  const auto degrees = [&](std::size_t hemisphere, const char* negative) {
    const int value = std::atoi(match[hemisphere + 1].str().c_str());
    if (match[hemisphere].str().find_first_of(negative) == std::string::npos) return value;
    if (value == 0) refuse(file, "the tiles at 0 degrees are N00 and E000");
    return -value;
  };
  const Corner corner{degrees(1, "Ss"), degrees(3, "Ww")};
  require_between_poles(file, corner.latitude_deg, corner.longitude_deg);
  return corner;
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
      const int height = static_cast<std::int16_t>((bytes[from] << 8) | bytes[from + 1]);
      const auto value = static_cast<float>(height);
      if (value != kVoidPost) {
        require_earthly(file, height, fmt::format("row {}, column {}", row + 1, column + 1));
      }
      heights[(width - 1 - row) * width + column] = value;
    }
  }
  return heights;
}

}  // namespace

Terrain read_hgt(const std::filesystem::path& file) {
  const Corner corner = south_west_corner(file);
  const int side = posts_per_side(file);
  return lay_out(file, {.southern_latitude_deg = corner.latitude_deg,
                        .western_longitude_deg = corner.longitude_deg,
                        .rows = side,
                        .columns = side,
                        .heights_m = read_posts(file, side)});
}

}  // namespace skein::navigation
