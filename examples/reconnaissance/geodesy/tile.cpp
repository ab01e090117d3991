#include "geodesy/tile.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <vector>

#include "skein/error.hpp"

namespace reconnaissance {
namespace {

constexpr int kPosts = 1201;
// So many posts apart places are exactly known; between them they are 0.1 m off.
constexpr int kExact = 20;
// Nearer to its edges nothing is looked for.
constexpr double kEdge_m = 1;

}  // namespace

Tile::Tile(const Geodetic& place)
    : south_deg_(static_cast<int>(std::floor(place.latitude_deg))),
      west_deg_(static_cast<int>(std::floor(place.longitude_deg))),
      frame_({south_deg_ + 0.5, west_deg_ + 0.5, 0}) {
  // Parallels bend towards the poles, and meridians come together there.
  const auto at = [&](double north, double east) {
    return frame_.to_local({south_deg_ + north, west_deg_ + east, 0});
  };
  south_m_ = std::max(at(0, 0.5).north_m, at(0, 1).north_m);
  west_m_ = -std::min(at(0, 1).east_m, at(1, 1).east_m);
  north_m_ = std::min(at(1, 0.5).north_m, at(1, 1).north_m);
}

Local Tile::nearest(const Local& place) const {
  return {std::clamp(place.north_m, kEdge_m, north_m_ - south_m_ - kEdge_m),
          std::clamp(place.east_m, kEdge_m, -2 * west_m_ - kEdge_m), place.height_m};
}

Local Tile::to_tile(const Geodetic& place) const {
  const Local from_middle = frame_.to_local(place);
  return {from_middle.north_m - south_m_, from_middle.east_m - west_m_, place.height_m};
}

Geodetic Tile::to_geodetic(const Local& in_tile) const {
  return frame_.to_geodetic(
      {in_tile.north_m + south_m_, in_tile.east_m + west_m_, in_tile.height_m});
}

std::string Tile::file_name() const {
  return fmt::format("{}{:02}{}{:03}.hgt", south_deg_ < 0 ? 'S' : 'N', std::abs(south_deg_),
                     west_deg_ < 0 ? 'W' : 'E', std::abs(west_deg_));
}

void Tile::write(const std::filesystem::path& file, const LocalFrame& frame,
                 const GroundHeight& ground) const {
  const auto exact = [&](int row, int column) {
    return frame.to_local({south_deg_ + 1 - static_cast<double>(row) / (kPosts - 1),
                           west_deg_ + static_cast<double>(column) / (kPosts - 1), 0});
  };
  std::string posts;
  posts.reserve(2 * kPosts * kPosts);
  for (int row = 0; row < kPosts; ++row) {
    for (int column = 0; column < kPosts; column += kExact) {
      const Local west = exact(row, column), east = exact(row, column + kExact);
      for (int i = 0; i < kExact && column + i < kPosts; ++i) {
        const double share = static_cast<double>(i) / kExact;
        const auto height =
            static_cast<int>(std::ceil(ground(std::lerp(west.north_m, east.north_m, share),
                                              std::lerp(west.east_m, east.east_m, share))));
        posts += {static_cast<char>(height >> 8), static_cast<char>(height & 0xff)};
      }
    }
  }
  std::ofstream stream(file, std::ios::binary | std::ios::trunc);
  stream << posts << std::flush;
  if (!stream) throw skein::Unavailable("the ground cannot be written: " + file.string());
}

}  // namespace reconnaissance
