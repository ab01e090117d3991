#pragma once

#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include "navigation/terrain/terrain.hpp"

// What the readers of tiles of one degree by one degree share.
namespace skein::navigation {

/// Stands for a post without data until the tile is laid out.
constexpr float kVoidPost = -32768;

/// Throws InvalidArgument with the file's name and the reason.
[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& why);

/// As throw_for_file() does.
[[noreturn]] void refuse_unread(const std::filesystem::path& file, const std::error_code& error);

/// Refuses heights that no mountain on earth has; `where` says which post it is.
void require_earthly(const std::filesystem::path& file, int height_m, const std::string& where);

/// Posts at equal distances in latitude and longitude, over whole degrees: a tile or several.
struct DegreePosts {
  int southern_latitude_deg = 0;
  int western_longitude_deg = 0;
  int degrees_north = 1;
  int degrees_east = 1;
  int rows = 0;
  int columns = 0;
  std::vector<float> heights_m;  ///< Row by row from the south, each from west to east.
};

/// Refuses a south-west corner that no tile has, and tiles that do not lie between 80 degrees south
/// and 84 degrees north, where UTM's zones are: nearer to a pole a tile is a narrow wedge.
void require_between_poles(const std::filesystem::path& file, int southern_latitude_deg,
                           int western_longitude_deg);

/// Fills the voids, each with the height of the highest post beside it, and lays posts out in
/// metres, as read_hgt says. Refuses posts that are all voids.
Terrain lay_out(const std::filesystem::path& file, DegreePosts posts);

}  // namespace skein::navigation
