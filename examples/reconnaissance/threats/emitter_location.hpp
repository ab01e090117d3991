#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "geodesy/local_frame.hpp"
#include "skein/fusion.hpp"

// Where an emitter on the ground stands, from bearings along a flight. Both ways are the body of a
// CSP of their own; their estimates are of north and east in metres.
namespace reconnaissance {

/// The direction of an emitter, clockwise from true north, from a place that is known well.
struct Bearing {
  Local from;
  double bearing_rad;
  double sigma_rad;  ///< Standard deviation of its normal error.
};

/// The most probable place by all bearings: weighted nonlinear least squares, begun at the point
/// nearest to the lines of bearing. The covariance is the inverse of Fisher's information
/// (Torrieri, "Statistical theory of passive location systems", IEEE Trans. AES 20(2), 1984).
///
/// nullopt while the bearings do not say enough: fewer than two, lines that hardly cross (a
/// standard deviation of more than 0.3 of the distance from the first or the last place), or that
/// meet behind the observer or just ahead of him.
std::optional<skein::fusion::Estimate> triangulate(std::span<const Bearing> bearings);

/// The greatest standard deviation of a place, as a share of its distance, that counts as known.
inline constexpr double kPlacedSigma = 0.3;

/// An extended Kalman filter for an emitter that stands still, with bearings alone.
///
/// Its state is modified polar about the place of the first bearing: that bearing, and the inverse
/// of the distance. In these the first bearing is linear, and the others nearly so however far the
/// emitter is, for parallax is proportional to the inverse of the distance. A filter in Cartesian
/// coordinates linearises about a distance that it has to invent, and becomes sure of it (Aidala,
/// "Kalman filter behavior in bearings-only tracking applications", IEEE Trans. AES 15(1), 1979;
/// Aidala and Hammel, "Utilization of modified polar coordinates for bearings-only tracking", IEEE
/// Trans. Automatic Control 28(3), 1983); with the logarithm of the distance it was overconfident,
/// too. Each update is iterated (Bell and Cathey, "The iterated
/// Kalman filter update as a Gauss-Newton method", IEEE Trans. Automatic Control 38(2), 1993).
class BearingFilter {
 public:
  /// Before more is heard, the emitter may be anywhere between the distances (both positive): each
  /// octave of distances is equally probable.
  BearingFilter(const Bearing& first, double least_range_m, double greatest_range_m);

  /// Not from a place so near to where the emitter is held to be that the bearing says nothing of
  /// it.
  void update(const Bearing& bearing);

  /// How a bearing differs from the expected one.
  struct Innovation {
    double difference_rad;
    double variance_rad2;  ///< Of the difference, by the errors of both.

    /// Chi-square distributed with one degree of freedom if the bearing is of this emitter.
    double squared() const { return difference_rad * difference_rad / variance_rad2; }
  };
  Innovation innovation(const Bearing& bearing) const;

  /// The standard deviation of the inverse of the distance as a share of it, nearly that of the
  /// distance.
  double relative_range_sigma() const;

  /// North and east; to be used when relative_range_sigma() is kPlacedSigma or less.
  skein::fusion::Estimate position() const;

  /// The filter's own state: bearing in radians, and the inverse of the distance in 1/km, both from
  /// the first place.
  skein::fusion::Estimate state() const;

 private:
  struct Expectation;
  Expectation expect(const Bearing& bearing, const Eigen::Vector2d& state) const;

  Eigen::Vector2d origin_km_;
  Eigen::Vector2d state_;
  Eigen::Matrix2d covariance_;
};

/// The place by a BearingFilter over all bearings (at least one), for a CSP that keeps nothing
/// between calls. nullopt while a standard deviation of the distance is more than 0.3 of it, from
/// the first place or from the last: what seems to be just ahead may be far ahead.
std::optional<skein::fusion::Estimate> filter_bearings(std::span<const Bearing> bearings,
                                                       double least_range_m,
                                                       double greatest_range_m);

}  // namespace reconnaissance
