#include "sensing/camera.hpp"

#include <cmath>

namespace reconnaissance {
namespace {

using Eigen::Matrix3d, Eigen::Vector3d;

constexpr double kRayStep_m = 30;
constexpr double kFurthest_m = 30000;
constexpr double kSlopeBase_m = 15;

/// Turns vectors of the camera (forward, right, down) into north, east, down.
Matrix3d camera_to_ned(const CameraPose& pose) {
  return body_to_ned(pose.attitude) *
         body_to_ned({0, pose.gimbal.elevation_rad, pose.gimbal.azimuth_rad});
}

Vector3d ray(const CameraPose& pose, const ImagePoint& point) {
  return camera_to_ned(pose) * Vector3d(1, point.right, point.down);
}

/// The place after a way along a straight ray, with the height above the curved earth.
Local along(const Local& start, const Vector3d& way) {
  return {start.north_m + way.x(), start.east_m + way.y(),
          start.height_m - way.z() + earth_drop_m(std::hypot(way.x(), way.y()), kOpticalEarth)};
}

/// The straight way to a place: against the horizontal plane at the start, the earth sinks.
Vector3d way_to(const Local& start, const Local& place) {
  Vector3d way = ned_between(start, place);
  way.z() += earth_drop_m(std::hypot(way.x(), way.y()), kOpticalEarth);
  return way;
}

double clearance_m(const Local& place, const GroundHeight& ground) {
  return place.height_m - ground(place.north_m, place.east_m);
}

/// Upward from the plane that touches the ground, in north, east, down.
Vector3d normal(const Local& place, const GroundHeight& ground) {
  const double n = place.north_m;
  const double e = place.east_m;
  const double northward =
      (ground(n + kSlopeBase_m, e) - ground(n - kSlopeBase_m, e)) / (2 * kSlopeBase_m);
  const double eastward =
      (ground(n, e + kSlopeBase_m) - ground(n, e - kSlopeBase_m)) / (2 * kSlopeBase_m);
  return Vector3d(-northward, -eastward, -1).normalized();
}

ImagePoint half_frame(const Camera& camera) {
  return {std::tan(camera.horizontal_view_rad / 2), std::tan(camera.vertical_view_rad / 2)};
}

}  // namespace

GimbalAngles point_at(const Local& camera, const Attitude& attitude, const Local& place) {
  const Vector3d way = body_to_ned(attitude).transpose() * way_to(camera, place);
  return {std::atan2(way.y(), way.x()), std::atan2(-way.z(), std::hypot(way.x(), way.y()))};
}

std::optional<ImagePoint> in_image(const CameraPose& pose, const Camera& camera,
                                   const Local& place) {
  const Vector3d way = camera_to_ned(pose).transpose() * way_to(pose.place, place);
  if (way.x() <= 0) return std::nullopt;
  const ImagePoint point{way.y() / way.x(), way.z() / way.x()};
  const ImagePoint half = half_frame(camera);
  if (std::abs(point.right) > half.right || std::abs(point.down) > half.down) return std::nullopt;
  return point;
}

std::optional<Local> ground_at(const CameraPose& pose, const ImagePoint& point,
                               const GroundHeight& ground) {
  const Vector3d step = ray(pose, point).normalized() * kRayStep_m;
  double above = 0;
  double below = 1;
  while (clearance_m(along(pose.place, below * step), ground) > 0) {
    above = below;
    below += 1;
    if (below * kRayStep_m > kFurthest_m) return std::nullopt;
  }
  while ((below - above) * kRayStep_m > 1e-3) {
    const double middle = (above + below) / 2;
    (clearance_m(along(pose.place, middle * step), ground) > 0 ? above : below) = middle;
  }
  return along(pose.place, below * step);
}

double Footprint::area_m2() const {
  double twice = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Local& a = corners[i];
    const Local& b = corners[(i + 1) % corners.size()];
    twice += a.north_m * b.east_m - b.north_m * a.east_m;
  }
  return std::abs(twice) / 2;
}

std::optional<Footprint> footprint(const CameraPose& pose, const Camera& camera,
                                   const GroundHeight& ground) {
  const auto [right, down] = half_frame(camera);
  const ImagePoint corners[]{{-right, -down}, {right, -down}, {right, down}, {-right, down}};
  Footprint footprint;
  for (std::size_t i = 0; i < footprint.corners.size(); ++i) {
    const auto corner = ground_at(pose, corners[i], ground);
    if (!corner) return std::nullopt;
    footprint.corners[i] = *corner;
  }
  const auto centre = ground_at(pose, {}, ground);
  if (!centre) return std::nullopt;
  footprint.centre = *centre;
  return footprint;
}

std::optional<GroundSample> ground_sample(const CameraPose& pose, const Camera& camera,
                                          const ImagePoint& point, const GroundHeight& ground) {
  const auto place = ground_at(pose, point, ground);
  if (!place) return std::nullopt;
  const Vector3d up = normal(*place, ground);
  const Vector3d direction = ray(pose, point);
  const double scale = way_to(pose.place, *place).norm() / direction.norm();
  const double slant = scale * direction.norm();
  const double sine = -up.dot(direction) / direction.norm();
  if (sine <= 0) return std::nullopt;
  // How the ray's point on the plane moves with the point of the image.
  const auto moved = [&](const Vector3d& axis) {
    return (scale * (axis - direction * (up.dot(axis) / up.dot(direction)))).norm();
  };
  const Matrix3d axes = camera_to_ned(pose);
  const auto [half_right, half_down] = half_frame(camera);
  return GroundSample{*place, slant, std::asin(std::min(1.0, sine)),
                      moved(axes.col(1)) * 2 * half_right / camera.columns,
                      moved(axes.col(2)) * 2 * half_down / camera.rows};
}

std::optional<GroundSample> ground_sample_of(const CameraPose& pose, const Camera& camera,
                                             const Local& place, const GroundHeight& ground) {
  const auto point = in_image(pose, camera, place);
  if (!point || !in_sight(pose.place, place, ground, kOpticalEarth)) return std::nullopt;
  return ground_sample(pose, camera, *point, ground);
}

}  // namespace reconnaissance
