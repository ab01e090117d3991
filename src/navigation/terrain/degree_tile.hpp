#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "navigation/terrain/terrain.hpp"

// What the readers of tiles of one degree by one degree share.
namespace skein::navigation {

/// Stands for a post without data until the tile is laid out.
constexpr float kVoidPost = -32768;

/// Throws InvalidArgument with the file's name and the reason.
[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& why);

/// Refuses heights that no mountain on earth has; `where` says which post it is.
void require_earthly(const std::filesystem::path& file, int height_m, const std::string& where);

/// Fills the voids, each with the height of the highest post beside it, and gives the posts their
/// distances on the earth. Refuses a tile of voids alone.
Terrain lay_out_tile(const std::filesystem::path& file, int southern_latitude_deg, int rows,
                     int columns, std::vector<float> heights_m);

}  // namespace skein::navigation
