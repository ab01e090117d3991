#include "navigation/route_checker/height_grid.hpp"

#include <fmt/core.h>

#include <GeographicLib/Geodesic.hpp>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <numeric>
#include <utility>

#include "dted_posts.hpp"
#include "rules.hpp"
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

/// Degrees north and east, from the name of a tile.
std::pair<int, int> corner_in(const std::string& name, const std::filesystem::path& file) {
  int north = 0, east = 0;
  char north_or_south = 0, east_or_west = 0;
  if (std::sscanf(name.c_str(), "%c%2d%c%3d", &north_or_south, &north, &east_or_west, &east) != 4) {
    throw InvalidArgument(
        fmt::format("{}: the name does not begin with a latitude and a longitude", file.string()));
  }
  return {std::toupper(north_or_south) == 'S' ? -north : north,
          std::toupper(east_or_west) == 'W' ? -east : east};
}

/// The heights of one tile, the northernmost row first.
std::vector<int> read_square(const std::filesystem::path& file, int& side) {
  std::vector<int> values = read_all(file.string());
  side = static_cast<int>(std::lround(std::sqrt(values.size())));
  if ((side != 1201 && side != 3601) || values.size() != static_cast<std::size_t>(side * side)) {
    throw InvalidArgument(fmt::format("{}: {} heights are no tile of 1201 or 3601 squared",
                                      file.string(), values.size()));
  }
  return values;
}

/// What the name and the sizes of SRTM tiles say, and their posts: one tile, or all between two.
TilePosts read_srtm_posts(const std::filesystem::path& file) {
  const std::string name = file.filename().string();
  const std::size_t dots = name.find("..");
  const auto [south, west] = corner_in(name, file);
  const auto last =
      dots == std::string::npos ? std::pair{south, west} : corner_in(name.substr(dots + 2), file);
  TilePosts posts;
  posts.southern_latitude_deg = south;
  posts.western_longitude_deg = west;
  posts.degrees_north = last.first - south + 1;
  posts.degrees_east = (last.second - west + 360) % 360 + 1;
  for (int degree = 0; degree < posts.degrees_north * posts.degrees_east; ++degree) {
    const int north = degree / posts.degrees_east, east = degree % posts.degrees_east;
    const int latitude = south + north;
    const int longitude = west + east < 180 ? west + east : west + east - 360;
    const std::filesystem::path tile =
        dots == std::string::npos
            ? file
            : file.parent_path() / fmt::format("{}{:02}{}{:03}.hgt", latitude < 0 ? "S" : "N",
                                               std::abs(latitude), longitude < 0 ? "W" : "E",
                                               std::abs(longitude));
    int side = 0;
    const std::vector<int> values = read_square(tile, side);
    if (degree == 0) {
      posts.rows = (side - 1) * posts.degrees_north + 1;
      posts.columns = (side - 1) * posts.degrees_east + 1;
      posts.heights_m.assign(
          static_cast<std::size_t>(posts.rows) * static_cast<std::size_t>(posts.columns), kNoData);
    }
    if ((side - 1) * posts.degrees_north + 1 != posts.rows) {
      throw InvalidArgument(
          fmt::format("{}: has another number of posts than {}", tile.string(), name));
    }
    for (int i = 0; i < side * side; ++i) {
      const int row = north * (side - 1) + side - 1 - i / side;
      const int column = east * (side - 1) + i % side;
      float& post =
          posts.heights_m[static_cast<std::size_t>(row) * static_cast<std::size_t>(posts.columns) +
                          static_cast<std::size_t>(column)];
      post = std::max(post, static_cast<float>(values[static_cast<std::size_t>(i)]));
    }
  }
  return posts;
}

/// Geodesics from the middle of a tile: the checker's own way to the frame of `navigator.idl`.
class Geodesics {
 public:
  Geodesics(double latitude, double longitude) : latitude_(latitude), longitude_(longitude) {}

  /// Metres east and north of the middle.
  std::pair<double, double> metres(double latitude, double longitude) const {
    double distance = 0, azimuth = 0, ignored = 0;
    GeographicLib::Geodesic::WGS84().Inverse(latitude_, longitude_, latitude, longitude, distance,
                                             azimuth, ignored);
    return {distance * std::sin(azimuth * kDegree), distance * std::cos(azimuth * kDegree)};
  }

  /// Degrees of longitude and latitude.
  std::pair<double, double> degrees(double east_m, double north_m) const {
    double latitude = 0, longitude = 0;
    GeographicLib::Geodesic::WGS84().Direct(latitude_, longitude_,
                                            std::atan2(east_m, north_m) / kDegree,
                                            std::hypot(east_m, north_m), latitude, longitude);
    return {longitude_ + std::remainder(longitude - longitude_, 360), latitude};
  }

 private:
  static constexpr double kDegree = std::numbers::pi / 180;
  double latitude_;
  double longitude_;
};

/// Fills in `count` places: geodesics for one in `step`, straight lines in between.
template <class Place>
void fill_row(std::vector<std::pair<double, double>>& places, int count, int step,
              const Place& place) {
  places.resize(static_cast<std::size_t>(count));
  for (int from = 0; from + 1 < count; from += step) {
    const int to = std::min(from + step, count - 1);
    const auto a = place(from), b = place(to);
    for (int i = from; i <= to; ++i) {
      const double share = static_cast<double>(i - from) / (to - from);
      places[static_cast<std::size_t>(i)] = {std::lerp(a.first, b.first, share),
                                             std::lerp(a.second, b.second, share)};
    }
  }
}

/// The ground in metres, from posts in degrees, as `navigator.idl` and read_hgt() promise it.
class GroundInMetres {
 public:
  explicit GroundInMetres(TilePosts tile)
      : tile_(std::move(tile)),
        south_(tile_.southern_latitude_deg),
        west_(tile_.western_longitude_deg),
        by_row_(static_cast<double>(tile_.degrees_north) / (tile_.rows - 1)),
        // At most 740 m, over which a straight line is wrong by centimetres.
        step_(std::max(1, (tile_.rows - 1) / tile_.degrees_north / 150)),
        by_column_(static_cast<double>(tile_.degrees_east) / (tile_.columns - 1)),
        geodesics_(south_ + tile_.degrees_north / 2.0, west_ + tile_.degrees_east / 2.0) {}

  HeightGrid make() {
    measure();
    interpolate();
    raise();
    return std::move(grid_);
  }

 private:
  void measure() {
    const double north = south_ + tile_.degrees_north, east = west_ + tile_.degrees_east;
    for (const double longitude : {(west_ + east) / 2, east}) {
      bottom_m_ = std::max(bottom_m_, geodesics_.metres(south_, longitude).second);
      top_m_ = std::min(top_m_, geodesics_.metres(north, longitude).second);
    }
    for (const double latitude : {south_, north}) {
      half_width_m_ = std::min(half_width_m_, geodesics_.metres(latitude, east).first);
    }
    grid_.rows = tile_.rows;
    grid_.columns = tile_.columns;
    grid_.north_spacing_m = (top_m_ - bottom_m_) / (grid_.rows - 1);
    grid_.east_spacing_m = 2 * half_width_m_ / (grid_.columns - 1);
  }

  void interpolate() {
    const HeightGrid raw{tile_.rows, tile_.columns, by_row_, by_column_, tile_.heights_m};
    std::vector<std::pair<double, double>> places;
    for (int row = 0; row < grid_.rows; ++row) {
      fill_row(places, grid_.columns, step_, [&](int column) {
        return geodesics_.degrees(column * grid_.east_spacing_m - half_width_m_,
                                  bottom_m_ + row * grid_.north_spacing_m);
      });
      for (const auto& [longitude, latitude] : places) {
        grid_.heights_m.push_back(static_cast<float>(
            route_checker::ground_height(raw, latitude - south_, longitude - west_)));
      }
    }
  }

  /// Lifts the corners around each post that stands above the ground, each by its share.
  void raise() {
    std::vector<float> raised = grid_.heights_m;
    std::vector<std::pair<double, double>> places;
    for (int row = 0; row < tile_.rows; ++row) {
      fill_row(places, tile_.columns, step_, [&](int column) {
        return geodesics_.metres(south_ + row * by_row_, west_ + column * by_column_);
      });
      for (int column = 0; column < tile_.columns; ++column) {
        const auto& [east_m, north_m] = places[static_cast<std::size_t>(column)];
        if (std::abs(east_m) > half_width_m_ || north_m < bottom_m_ || north_m > top_m_) continue;
        raise_to(tile_.heights_m[post(row, column)], north_m - bottom_m_, east_m + half_width_m_,
                 raised);
      }
    }
    grid_.heights_m = std::move(raised);
  }

  void raise_to(double height_m, double north_m, double east_m, std::vector<float>& raised) const {
    const double lacking = height_m - route_checker::ground_height(grid_, north_m, east_m);
    if (!(lacking > 0)) return;
    const double x = north_m / grid_.north_spacing_m, y = east_m / grid_.east_spacing_m;
    const int i = std::min(static_cast<int>(x), grid_.rows - 2);
    const int j = std::min(static_cast<int>(y), grid_.columns - 2);
    const auto squares = [](double t) { return t * t + (1 - t) * (1 - t); };
    for (const int north : {0, 1}) {
      for (const int east : {0, 1}) {
        const double share = (1 - std::abs(i + north - x)) * (1 - std::abs(j + east - y));
        const std::size_t corner = post(i + north, j + east);
        raised[corner] = std::max(
            raised[corner], static_cast<float>(grid_.heights_m[corner] +
                                               lacking * share / squares(x - i) / squares(y - j)));
      }
    }
  }

  std::size_t post(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(tile_.columns) +
           static_cast<std::size_t>(column);
  }

  const TilePosts tile_;
  const double south_;
  const double west_;
  const double by_row_;
  const int step_;
  const double by_column_;
  const Geodesics geodesics_;
  double bottom_m_ = -1e9;
  double top_m_ = 1e9;
  double half_width_m_ = 1e9;
  HeightGrid grid_;
};

bool is_dted(const std::filesystem::path& file) {
  const std::string ending = file.extension().string();
  return ending.size() == 4 && (ending[1] == 'd' || ending[1] == 'D');
}

}  // namespace

HeightGrid read_height_grid(const std::filesystem::path& file) {
  TilePosts tile = is_dted(file) ? read_dted_posts(file) : read_srtm_posts(file);
  fill_voids(tile.heights_m, tile.columns);
  return GroundInMetres(std::move(tile)).make();
}

}  // namespace skein::navigation
