#include "geodesy/tile.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <vector>

#include "skein/error.hpp"

namespace reconnaissance {
namespace {

constexpr double kDegree_m = 111195.08;
constexpr int kPosts = 1201;
// So many posts apart places are exactly known; between them they are 0.1 m off.
constexpr int kExact = 20;

}  // namespace

Tile::Tile(const Geodetic& place)
    : south_deg_(static_cast<int>(std::floor(place.latitude_deg))),
      west_deg_(static_cast<int>(std::floor(place.longitude_deg))),
      degree_east_m_(kDegree_m * std::cos((south_deg_ + 0.5) * std::numbers::pi / 180)) {}

Local Tile::to_tile(const Geodetic& place) const {
  return {(place.latitude_deg - south_deg_) * kDegree_m,
          (place.longitude_deg - west_deg_) * degree_east_m_, place.height_m};
}

Geodetic Tile::to_geodetic(const Local& in_tile) const {
  return {south_deg_ + in_tile.north_m / kDegree_m, west_deg_ + in_tile.east_m / degree_east_m_,
          in_tile.height_m};
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
