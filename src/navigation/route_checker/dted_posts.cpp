#include "dted_posts.hpp"

#include <fmt/core.h>

#include <cstdio>
#include <cstdlib>

#include "core/system/whole_file.hpp"
#include "skein/error.hpp"

namespace skein::navigation {
namespace {

constexpr std::size_t kFirstColumn = 3428;    // After all headers.
constexpr std::size_t kLargest = 32'000'000;  // 3601 columns of 3601 posts have 26 million bytes.

int byte_at(const std::string& text, std::size_t at) {
  return static_cast<unsigned char>(text[at]);
}

}  // namespace

TilePosts read_dted_posts(const std::filesystem::path& file) {
  const std::string text = read_whole_file("the terrain", file, kLargest);
  TilePosts tile;
  int longitude_lines = 0, latitude_points = 0;
  if (text.size() < kFirstColumn ||
      std::sscanf(text.c_str() + 47, "%4d%4d", &longitude_lines, &latitude_points) != 2 ||
      longitude_lines < 2 || latitude_points < 2) {
    throw InvalidArgument(
        fmt::format("{}: the route checker finds no DTED headers", file.string()));
  }
  tile.rows = latitude_points;
  tile.columns = longitude_lines;
  tile.southern_latitude_deg = std::atoi(text.substr(12, 3).c_str()) * (text[19] == 'S' ? -1 : 1);
  tile.western_longitude_deg = std::atoi(text.substr(4, 3).c_str()) * (text[11] == 'W' ? -1 : 1);
  const auto rows = static_cast<std::size_t>(tile.rows);
  const std::size_t column_bytes = 12 + 2 * rows;
  if (text.size() != kFirstColumn + column_bytes * static_cast<std::size_t>(tile.columns)) {
    throw InvalidArgument(
        fmt::format("{}: has {} bytes, which do not fit its {} columns of {} posts", file.string(),
                    text.size(), tile.columns, tile.rows));
  }
  for (std::size_t row = 0; row < rows; ++row) {
    for (int column = 0; column < tile.columns; ++column) {
      const std::size_t at =
          kFirstColumn + column_bytes * static_cast<std::size_t>(column) + 8 + 2 * row;
      const int stored = byte_at(text, at) * 256 + byte_at(text, at + 1);
      const int height = stored < 32768 ? stored : 32768 - stored;
      tile.heights_m.push_back(static_cast<float>(height == -32767 ? -32768 : height));
    }
  }
  return tile;
}

}  // namespace skein::navigation
