#include <fmt/core.h>

#include <algorithm>
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

/// The tiles of a terrain: all between two of one folder, which are the same for a single one.
struct Tiles {
  std::filesystem::path folder;
  Corner south_west;
  int degrees_north;
  int degrees_east;

  std::filesystem::path file(int north, int east) const {
    const int latitude = south_west.latitude_deg + north;
    const int longitude = (south_west.longitude_deg + east + 180) % 360 - 180;
    return folder / fmt::format("{}{:02}{}{:03}.hgt", latitude < 0 ? 'S' : 'N', std::abs(latitude),
                                longitude < 0 ? 'W' : 'E', std::abs(longitude));
  }
};

constexpr int kMostDegrees = 3;                 ///< A side: further out a flat frame is too wrong.
constexpr std::size_t kMostPosts = 52'000'000;  ///< Two by two tiles of 3601 x 3601.

/// The south-west corner, from a name such as `S07W123.hgt`.
Corner south_west_corner(const std::string& name, const std::filesystem::path& file) {
  static const std::regex kName(R"(([NS])(\d\d)([EW])(\d\d\d)\.hgt)", std::regex::icase);
  std::smatch match;
  if (!std::regex_match(name, match, kName)) {
    refuse(
        file,
        "the name does not say where the tile lies; it must be like N53E027.hgt, or like "
        "N53E027.hgt..N54E028.hgt for all tiles from the south-western to the north-eastern one");
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

Tiles tiles_of(const std::filesystem::path& file) {
  const std::string name = file.filename().string();
  const std::size_t dots = std::min(name.find(".."), name.size());
  const Corner first = south_west_corner(name.substr(0, dots), file);
  const Corner last = dots == name.size() ? first : south_west_corner(name.substr(dots + 2), file);
  const Tiles tiles{file.parent_path(), first, last.latitude_deg - first.latitude_deg + 1,
                    (last.longitude_deg - first.longitude_deg + 360) % 360 + 1};
  if (tiles.degrees_north < 1 || tiles.degrees_north > kMostDegrees ||
      tiles.degrees_east > kMostDegrees) {
    refuse(file, fmt::format("spans {} by {} degrees north and east; the second tile is the "
                             "north-eastern one, and 3 by 3 are the most",
                             tiles.degrees_north, tiles.degrees_east));
  }
  return tiles;
}

void require_all(const Tiles& tiles, const std::filesystem::path& file) {
  std::string missing;
  for (int north = 0; north < tiles.degrees_north; ++north) {
    for (int east = 0; east < tiles.degrees_east; ++east) {
      const std::filesystem::path tile = tiles.file(north, east);
      std::error_code ignored;
      if (std::filesystem::exists(tile, ignored)) continue;
      missing += (missing.empty() ? "" : ", ") + tile.filename().string();
    }
  }
  if (missing.empty()) return;
  refuse(file, fmt::format("lacks {} in '{}'; SRTM has no tile of open sea, for which a file of "
                           "2884802 zero bytes stands",
                           missing, tiles.folder.string()));
}

int posts_per_side(const std::filesystem::path& file) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error) refuse_unread(file, error);
  for (const int side : {1201, 3601}) {
    if (size == 2U * static_cast<std::uintmax_t>(side) * static_cast<std::uintmax_t>(side)) {
      return side;
    }
  }
  refuse(file, fmt::format("has {} bytes; an SRTM tile has 2884802 (1201 x 1201 posts) or 25934402 "
                           "(3601 x 3601); the file is cut off or something else",
                           size));
}

std::vector<float> read_heights(const std::filesystem::path& file, int side) {
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

/// Puts a tile among the posts of all. Tiles share the posts of their edges: the higher one
/// counts, and any height before a void, which is the lowest of all.
void put(const std::vector<float>& tile_m, int side, int north, int east, DegreePosts& posts) {
  for (int row = 0; row < side; ++row) {
    const auto from = tile_m.begin() + static_cast<std::ptrdiff_t>(row) * side;
    const auto to = posts.heights_m.begin() +
                    static_cast<std::ptrdiff_t>(north * (side - 1) + row) * posts.columns +
                    static_cast<std::ptrdiff_t>(east) * (side - 1);
    std::transform(from, from + side, to, to, [](float a, float b) { return std::max(a, b); });
  }
}

DegreePosts read_tiles(const Tiles& tiles, const std::filesystem::path& file) {
  const std::filesystem::path first = tiles.file(0, 0);
  const int side = posts_per_side(first);
  DegreePosts posts{.southern_latitude_deg = tiles.south_west.latitude_deg,
                    .western_longitude_deg = tiles.south_west.longitude_deg,
                    .degrees_north = tiles.degrees_north,
                    .degrees_east = tiles.degrees_east,
                    .rows = tiles.degrees_north * (side - 1) + 1,
                    .columns = tiles.degrees_east * (side - 1) + 1,
                    .heights_m = {}};
  const std::size_t count =
      static_cast<std::size_t>(posts.rows) * static_cast<std::size_t>(posts.columns);
  if (count > kMostPosts) {
    refuse(file, fmt::format("has {} posts, and {} are the most; tiles of 1201 x 1201 have fewer",
                             count, kMostPosts));
  }
  posts.heights_m.assign(count, kVoidPost);
  for (int north = 0; north < tiles.degrees_north; ++north) {
    for (int east = 0; east < tiles.degrees_east; ++east) {
      const std::filesystem::path tile = tiles.file(north, east);
      if (const int other = posts_per_side(tile); other != side) {
        refuse(tile, fmt::format("has {0} x {0} posts, and {1} has {2} x {2}; tiles of one terrain "
                                 "have the same number",
                                 other, first.filename().string(), side));
      }
      put(read_heights(tile, side), side, north, east, posts);
    }
  }
  return posts;
}

}  // namespace

Terrain read_hgt(const std::filesystem::path& file) {
  const Tiles tiles = tiles_of(file);
  if (file.filename().string().find("..") == std::string::npos) {
    const int side = posts_per_side(file);
    return lay_out(file, {.southern_latitude_deg = tiles.south_west.latitude_deg,
                          .western_longitude_deg = tiles.south_west.longitude_deg,
                          .rows = side,
                          .columns = side,
                          .heights_m = read_heights(file, side)});
  }
  require_all(tiles, file);
  return lay_out(file, read_tiles(tiles, file));
}

}  // namespace skein::navigation
