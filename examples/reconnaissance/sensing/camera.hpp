#pragma once

#include <algorithm>
#include <array>
#include <optional>

#include "geodesy/attitude.hpp"
#include "geodesy/line_of_sight.hpp"

namespace reconnaissance {

/// A pinhole camera with frames of `columns` by `rows` pixels.
struct Camera {
  double horizontal_view_rad;
  double vertical_view_rad;
  int columns;
  int rows;
};

/// Where a gimbal points: azimuth clockwise from the nose, elevation above the plane of the wings
/// (-π/2 is straight down in level flight).
struct GimbalAngles {
  double azimuth_rad;
  double elevation_rad;
};

struct CameraPose {
  Local place;
  Attitude attitude;
  GimbalAngles gimbal;
};

/// A point of the image by its tangents from the optical axis: right and down. The edges of the
/// frame are at ± the tangent of half of the view.
struct ImagePoint {
  double right = 0;
  double down = 0;
};

/// The gimbal angles that put a place into the middle of the image.
GimbalAngles point_at(const Local& camera, const Attitude& attitude, const Local& place);

/// Where a place is in the image; nullopt outside of the frame. Does not ask whether ground hides
/// it: in_sight(…, kOpticalEarth) does.
std::optional<ImagePoint> in_image(const CameraPose& pose, const Camera& camera,
                                   const Local& place);

/// The ground that a point of the image shows, over an earth with the refraction of light: nullopt
/// if it shows none within 30 km. Narrower ridges than 30 m may be overlooked.
std::optional<Local> ground_at(const CameraPose& pose, const ImagePoint& point,
                               const GroundHeight& ground);

/// What the frame shows of the ground: its corners, from the upper left clockwise.
struct Footprint {
  std::array<Local, 4> corners;
  Local centre;

  /// Of the corners' quadrangle on the map.
  double area_m2() const;
};

/// nullopt if a corner or the centre shows no ground.
std::optional<Footprint> footprint(const CameraPose& pose, const Camera& camera,
                                   const GroundHeight& ground);

/// How far neighbouring pixels are apart on the ground.
struct GroundSample {
  Local place;
  double slant_range_m;
  double grazing_rad;       ///< Between the line of sight and the ground's slope.
  double across_columns_m;  ///< From a column to the next.
  double across_rows_m;     ///< From a row to the next: longer by 1 / sin(grazing) in level flight.

  /// What a requirement is held against: the coarser of both.
  double distance_m() const { return std::max(across_columns_m, across_rows_m); }
};

/// The ground sample distances at a point of the image: of the central projection of a pixel onto
/// the plane that touches the ground there. nullopt if it shows no ground. In the middle of the
/// image of level ground, slant range times a pixel's angle, and that over the sine of the grazing
/// angle (Leachtenauer and Driggers, "Surveillance and Reconnaissance Imaging Systems", 2001).
std::optional<GroundSample> ground_sample(const CameraPose& pose, const Camera& camera,
                                          const ImagePoint& point, const GroundHeight& ground);

/// The same for a place on the ground that may be hidden or outside of the frame: nullopt then.
std::optional<GroundSample> ground_sample_of(const CameraPose& pose, const Camera& camera,
                                             const Local& place, const GroundHeight& ground);

}  // namespace reconnaissance
