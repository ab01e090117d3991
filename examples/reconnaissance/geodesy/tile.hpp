#pragma once

#include <filesystem>

#include "geodesy/line_of_sight.hpp"
#include "geodesy/local_frame.hpp"

namespace reconnaissance {

/// A tile of one degree by one degree as Skein's planners of routes lay it out (navigator.idl):
/// flat, with its origin in the south-western corner, a degree of latitude 111195.08 m long, one of
/// longitude that times the cosine in the middle of the tile. Places stay where they are on
/// WGS-84; what planners take for distances is up to 1.3 % wrong.
class Tile {
 public:
  static constexpr double kLargestError = 0.013;

  /// The one in which the place is.
  explicit Tile(const Geodetic& place);

  Local to_tile(const Geodetic& place) const;
  Geodetic to_geodetic(const Local& in_tile) const;

  /// As `N53E027.hgt`.
  std::string file_name() const;

  /// Writes the ground in SRTM's format, posts three seconds apart, each rounded up to metres.
  /// `ground` is asked for places about the `frame`'s origin. Throws skein::Unavailable if the file
  /// cannot be written.
  void write(const std::filesystem::path& file, const LocalFrame& frame,
             const GroundHeight& ground) const;

 private:
  int south_deg_;
  int west_deg_;
  double degree_east_m_;
};

}  // namespace reconnaissance
