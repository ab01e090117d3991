#pragma once

#include <filesystem>

#include "geodesy/line_of_sight.hpp"
#include "geodesy/local_frame.hpp"

namespace reconnaissance {

/// A tile of one degree by one degree as Skein's planners of routes lay it out (navigator.idl): the
/// largest rectangle within it that is symmetric about its middle meridian, in metres from its
/// south-western corner. Distances are right to 20 parts in a million.
class Tile {
 public:
  /// The one in which the place is.
  explicit Tile(const Geodetic& place);

  Local to_tile(const Geodetic& place) const;
  Geodetic to_geodetic(const Local& in_tile) const;

  /// What of the tile is nearest, at the same height; both in its coordinates.
  Local nearest(const Local& place) const;

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
  LocalFrame frame_;    // about the middle
  double south_m_ = 0;  // The rectangle's edges there.
  double west_m_ = 0;
  double north_m_ = 0;
};

}  // namespace reconnaissance
