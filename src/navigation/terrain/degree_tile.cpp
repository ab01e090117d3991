#include "navigation/terrain/degree_tile.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/system/passing_error.hpp"
#include "skein/error.hpp"

namespace skein::navigation {
namespace {

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

/// A place in a grid, in posts from its south-west corner.
struct GridPlace {
  double row;
  double column;
};

/// The four posts around a place, and how much of each is there.
struct Surrounding {
  std::array<std::size_t, 4> posts;
  std::array<double, 4> shares;

  Surrounding(const GridPlace& place, int rows, int columns) {
    const double u = std::clamp(place.row, 0.0, rows - 1.0);
    const double v = std::clamp(place.column, 0.0, columns - 1.0);
    const int row = std::min(static_cast<int>(u), rows - 2);
    const int column = std::min(static_cast<int>(v), columns - 2);
    const auto width = static_cast<std::size_t>(columns);
    const std::size_t first =
        static_cast<std::size_t>(row) * width + static_cast<std::size_t>(column);
    posts = {first, first + 1, first + width, first + width + 1};
    const double north = u - row, east = v - column;
    shares = {(1 - north) * (1 - east), (1 - north) * east, north * (1 - east), north * east};
  }

  double height_m(const std::vector<float>& heights_m) const {
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i) sum += shares[i] * heights_m[posts[i]];
    return sum;
  }
};

/// Where each post of one grid lies in another: exactly so for 150 to a degree of latitude, linear
/// between these, which is right to centimetres.
class PlacesOfPosts {
 public:
  template <class Exact>
  PlacesOfPosts(const DegreePosts& posts, Exact exact)
      : step_(std::max(1, (posts.rows - 1) / posts.degrees_north / 150)),
        width_((posts.columns - 2) / step_ + 2) {
    const int height = (posts.rows - 2) / step_ + 2;
    places_.reserve(static_cast<std::size_t>(height) * static_cast<std::size_t>(width_));
    for (int row = 0; row < height; ++row) {
      for (int column = 0; column < width_; ++column) {
        places_.push_back(exact(row * step_, column * step_));
      }
    }
  }

  GridPlace of(int row, int column) const {
    const double north = static_cast<double>(row % step_) / step_;
    const double east = static_cast<double>(column % step_) / step_;
    const GridPlace* south =
        &places_[static_cast<std::size_t>(row / step_ * width_ + column / step_)];
    const GridPlace* upper = row % step_ == 0 ? south : south + width_;
    const std::size_t next = column % step_ == 0 ? 0 : 1;
    const auto mix = [&](double a, double b, double c, double d) {
      return (1 - north) * ((1 - east) * a + east * b) + north * ((1 - east) * c + east * d);
    };
    return {mix(south[0].row, south[next].row, upper[0].row, upper[next].row),
            mix(south[0].column, south[next].column, upper[0].column, upper[next].column)};
  }

 private:
  int step_;
  int width_;
  std::vector<GridPlace> places_;
};

/// The largest rectangle within these degrees that is symmetric about their middle meridian, and
/// the posts' places in it.
class Rectangle {
 public:
  explicit Rectangle(const DegreePosts& degrees)
      : south_(degrees.southern_latitude_deg),
        west_(degrees.western_longitude_deg),
        rows_per_degree_((degrees.rows - 1.0) / degrees.degrees_north),
        columns_per_degree_((degrees.columns - 1.0) / degrees.degrees_east),
        middle_{south_ + degrees.degrees_north / 2.0, west_ + degrees.degrees_east / 2.0},
        frame_(middle_, {0, 0}) {
    const double north = south_ + degrees.degrees_north;
    const double east = west_ + degrees.degrees_east;
    const auto at = [&](double latitude, double longitude) {
      return frame_.to_ground({latitude, longitude});
    };
    // Parallels bend towards the poles, and meridians come together there.
    const auto south_east = at(south_, east), north_east = at(north, east);
    const double bottom = std::max(south_east.north_m, at(south_, middle_.longitude_deg).north_m);
    const double top = std::min(north_east.north_m, at(north, middle_.longitude_deg).north_m);
    const double half_width = std::min(south_east.east_m, north_east.east_m);
    frame_ = EarthFrame(middle_, {-bottom, half_width});
    north_spacing_m_ = (top - bottom) / (degrees.rows - 1);
    east_spacing_m_ = 2 * half_width / (degrees.columns - 1);
  }

  const EarthFrame& frame() const { return frame_; }
  double north_spacing_m() const { return north_spacing_m_; }
  double east_spacing_m() const { return east_spacing_m_; }

  /// Where a post of the rectangle lies among those of the degrees.
  GridPlace in_degrees(int row, int column) const {
    const EarthPlace place = frame_.to_earth({row * north_spacing_m_, column * east_spacing_m_});
    const double from_middle = std::remainder(place.longitude_deg - middle_.longitude_deg, 360);
    return {(place.latitude_deg - south_) * rows_per_degree_,
            (from_middle + middle_.longitude_deg - west_) * columns_per_degree_};
  }

  /// Where a post of the degrees lies among those of the rectangle.
  GridPlace in_rectangle(int row, int column) const {
    const auto point =
        frame_.to_ground({south_ + row / rows_per_degree_, west_ + column / columns_per_degree_});
    return {point.north_m / north_spacing_m_, point.east_m / east_spacing_m_};
  }

 private:
  double south_;
  double west_;
  double rows_per_degree_;
  double columns_per_degree_;
  EarthPlace middle_;
  EarthFrame frame_;
  double north_spacing_m_;
  double east_spacing_m_;
};

/// Raises the ground to each of the tile's posts that stands above it. The posts around share the
/// raise by how near they are, so that a small change of places is a small change of heights.
void raise_to_posts(std::vector<float>& ground_m, const DegreePosts& degrees,
                    const PlacesOfPosts& places) {
  std::vector<float> raise_m(ground_m.size());
  for (int row = 0; row < degrees.rows; ++row) {
    for (int column = 0; column < degrees.columns; ++column) {
      const GridPlace place = places.of(row, column);
      if (place.row < 0 || place.column < 0 || place.row > degrees.rows - 1 ||
          place.column > degrees.columns - 1) {
        continue;
      }
      const Surrounding around(place, degrees.rows, degrees.columns);
      const std::size_t post =
          static_cast<std::size_t>(row) * static_cast<std::size_t>(degrees.columns) +
          static_cast<std::size_t>(column);
      const double lacking_m = degrees.heights_m[post] - around.height_m(ground_m);
      if (lacking_m <= 0) continue;
      double squares = 0;
      for (const double share : around.shares) squares += share * share;
      for (std::size_t i = 0; i < 4; ++i) {
        float& raise = raise_m[around.posts[i]];
        raise = std::max(raise, static_cast<float>(lacking_m * around.shares[i] / squares));
      }
    }
  }
  for (std::size_t post = 0; post < ground_m.size(); ++post) ground_m[post] += raise_m[post];
}

}  // namespace

void refuse(const std::filesystem::path& file, const std::string& why) {
  throw InvalidArgument(fmt::format("{}: {}", file.string(), why));
}

void refuse_unread(const std::filesystem::path& file, const std::error_code& error) {
  throw_for_file(error.value(),
                 fmt::format("{}: cannot be read: {}", file.string(), error.message()));
}

void require_earthly(const std::filesystem::path& file, int height_m, const std::string& where) {
  if (height_m >= -500 && height_m <= 9000) return;
  refuse(file,
         fmt::format("has a height of {} m in {}; the heights of the earth are between -500 m "
                     "and 9000 m",
                     height_m, where));
}

void require_between_poles(const std::filesystem::path& file, int southern_latitude_deg,
                           int western_longitude_deg) {
  if (southern_latitude_deg < -90 || southern_latitude_deg > 89) {
    refuse(file, "there is no such latitude");
  }
  if (western_longitude_deg < -180 || western_longitude_deg > 179) {
    refuse(file, "there is no such longitude; tiles begin at W180 to W001 and E000 to E179");
  }
  if (southern_latitude_deg < -80 || southern_latitude_deg > 83) {
    refuse(file, fmt::format("lies at {} degrees {}; tiles are taken from 80 degrees south to 84 "
                             "degrees north, since nearer to a pole they are narrow wedges",
                             std::abs(southern_latitude_deg),
                             southern_latitude_deg < 0 ? "south" : "north"));
  }
}

Terrain lay_out(const std::filesystem::path& file, DegreePosts posts) {
  for (std::size_t post = 0; post < posts.heights_m.size(); ++post) {
    if (posts.heights_m[post] != kVoidPost) continue;
    fill_void(posts.heights_m, static_cast<std::size_t>(posts.columns), post, file);
  }
  const Rectangle rectangle(posts);
  const PlacesOfPosts in_degrees(
      posts, [&](int row, int column) { return rectangle.in_degrees(row, column); });
  std::vector<float> ground_m;
  ground_m.reserve(posts.heights_m.size());
  for (int row = 0; row < posts.rows; ++row) {
    for (int column = 0; column < posts.columns; ++column) {
      const Surrounding around(in_degrees.of(row, column), posts.rows, posts.columns);
      ground_m.push_back(static_cast<float>(around.height_m(posts.heights_m)));
    }
  }
  raise_to_posts(ground_m, posts, PlacesOfPosts(posts, [&](int row, int column) {
                   return rectangle.in_rectangle(row, column);
                 }));
  return Terrain(file.string(), posts.rows, posts.columns, rectangle.north_spacing_m(),
                 rectangle.east_spacing_m(), std::move(ground_m), rectangle.frame());
}

}  // namespace skein::navigation
