#include "navigation/route_checker/height_grid.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <numeric>

#include "dted_posts.hpp"
#include "skein/error.hpp"

namespace skein::navigation {
namespace {

constexpr int kNoData = -32768;

/// Sets of posts that hang together.
class Sets {
 public:
  explicit Sets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  std::size_t find(std::size_t post) {
    while (parent_[post] != post) post = parent_[post] = parent_[parent_[post]];
    return post;
  }
  void join(std::size_t one, std::size_t other) { parent_[find(one)] = find(other); }

 private:
  std::vector<std::size_t> parent_;
};

std::vector<int> read_all(const std::string& path) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"),
                                                             std::fclose);
  if (!file) throw InvalidArgument(fmt::format("{}: the route checker cannot open it", path));
  constexpr std::size_t kLargest = 3601 * 3601;
  std::vector<int> values;
  unsigned char pair[2];
  while (values.size() <= kLargest && std::fread(pair, 2, 1, file.get()) == 1) {
    const int value = pair[0] * 256 + pair[1];
    values.push_back(value < 32768 ? value : value - 65536);
  }
  return values;
}

void fill_voids(std::vector<float>& heights, int columns) {
  const auto width = static_cast<std::size_t>(columns);
  const auto is_void = [&](std::size_t post) { return heights[post] == kNoData; };
  if (std::none_of(heights.begin(), heights.end(), [](float h) { return h == kNoData; })) return;
  Sets sets(heights.size());
  const auto for_each_pair = [&](auto&& action) {
    for (std::size_t post = 0; post < heights.size(); ++post) {
      if ((post + 1) % width != 0) action(post, post + 1);
      if (post + width < heights.size()) action(post, post + width);
    }
  };
  for_each_pair([&](std::size_t a, std::size_t b) {
    if (is_void(a) && is_void(b)) sets.join(a, b);
  });
  std::vector<float> rim(heights.size(), kNoData);
  for_each_pair([&](std::size_t a, std::size_t b) {
    if (is_void(a) == is_void(b)) return;
    float& highest = rim[sets.find(is_void(a) ? a : b)];
    highest = std::max(highest, heights[is_void(a) ? b : a]);
  });
  for (std::size_t post = 0; post < heights.size(); ++post) {
    if (is_void(post)) heights[post] = rim[sets.find(post)];
  }
}

/// What the name and the size of an SRTM tile say, and its posts.
TilePosts read_srtm_posts(const std::filesystem::path& file) {
  const std::string name = file.stem().string();
  int degrees = 0;
  char hemisphere = 0;
  if (std::sscanf(name.c_str(), "%c%2d", &hemisphere, &degrees) != 2) {
    throw InvalidArgument(
        fmt::format("{}: the name does not begin with a latitude", file.string()));
  }
  const std::vector<int> values = read_all(file.string());
  TilePosts tile;
  tile.southern_latitude_deg = std::toupper(hemisphere) == 'S' ? -degrees : degrees;
  tile.rows = tile.columns = static_cast<int>(std::lround(std::sqrt(values.size())));
  if (tile.rows != 1201 && tile.rows != 3601) {
    throw InvalidArgument(fmt::format("{}: {} heights are no tile of 1201 or 3601 squared",
                                      file.string(), values.size()));
  }
  for (int row = tile.rows; row-- > 0;) {
    const auto begin = values.begin() + static_cast<std::ptrdiff_t>(row) * tile.columns;
    tile.heights_m.insert(tile.heights_m.end(), begin, begin + tile.columns);
  }
  return tile;
}

bool is_dted(const std::filesystem::path& file) {
  const std::string ending = file.extension().string();
  return ending.size() == 4 && (ending[1] == 'd' || ending[1] == 'D');
}

}  // namespace

HeightGrid read_height_grid(const std::filesystem::path& file) {
  TilePosts tile = is_dted(file) ? read_dted_posts(file) : read_srtm_posts(file);
  fill_voids(tile.heights_m, tile.columns);
  HeightGrid grid;
  grid.rows = tile.rows;
  grid.columns = tile.columns;
  grid.heights_m = std::move(tile.heights_m);
  const double degree_m = 2 * std::numbers::pi * 6371008.8 / 360;
  const double middle = (2 * tile.southern_latitude_deg + 1) * std::numbers::pi / 360;
  grid.north_spacing_m = degree_m / (grid.rows - 1);
  grid.east_spacing_m = degree_m * std::cos(middle) / (grid.columns - 1);
  return grid;
}

}  // namespace skein::navigation
