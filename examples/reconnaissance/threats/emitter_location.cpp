#include "threats/emitter_location.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace reconnaissance {
namespace {

using Eigen::Matrix2d, Eigen::RowVector2d, Eigen::Vector2d;

constexpr int kSteps = 20;
// Of the first distance, what is left where a bearing changes too much with the place for a filter
// that takes it as linear: it would be sure that the emitter is where the aircraft is.
constexpr double kNear = 0.1;
constexpr double kKilometres_per_metre = 1e-3;  // The filter's numbers are of similar size.

Vector2d on_plane(const Local& local) { return {local.north_m, local.east_m}; }

Vector2d direction(double bearing_rad) { return {std::cos(bearing_rad), std::sin(bearing_rad)}; }
Vector2d across(double bearing_rad) { return {-std::sin(bearing_rad), std::cos(bearing_rad)}; }

double expected_bearing(const Vector2d& way) { return std::atan2(way.y(), way.x()); }

/// How a bearing changes with the place of what is seen along `way`.
RowVector2d bearing_by_position(const Vector2d& way) {
  return RowVector2d(-way.y(), way.x()) / way.squaredNorm();
}

double half_turn(double angle_rad) { return std::remainder(angle_rad, 2 * std::numbers::pi); }

skein::fusion::Estimate estimate(const Vector2d& mean, const Matrix2d& covariance) {
  const double cross = (covariance(0, 1) + covariance(1, 0)) / 2;
  return {{mean.x(), mean.y()}, {covariance(0, 0), cross, cross, covariance(1, 1)}};
}

/// The point with the least weighted squares of distances from the lines of bearing.
std::optional<Vector2d> nearest_to_lines(std::span<const Bearing> bearings) {
  Matrix2d normal = Matrix2d::Zero();
  Vector2d right = Vector2d::Zero();
  for (const Bearing& bearing : bearings) {
    const RowVector2d normal_to_line = across(bearing.bearing_rad).transpose();
    const double weight = 1 / (bearing.sigma_rad * bearing.sigma_rad);
    normal += weight * normal_to_line.transpose() * normal_to_line;
    right += weight * normal_to_line.transpose() * (normal_to_line * on_plane(bearing.from));
  }
  const Eigen::LDLT<Matrix2d> solver(normal);
  if (solver.rcond() < 1e-9) return std::nullopt;
  return solver.solve(right);
}

/// Whether a place is, with that standard deviation, from where the emitter was heard first and
/// last: what seems to be just ahead may be far ahead.
bool is_known(const Vector2d& emitter, double sigma_m, std::span<const Bearing> bearings) {
  const double first_m = (emitter - on_plane(bearings.front().from)).norm();
  const double last_m = (emitter - on_plane(bearings.back().from)).norm();
  return last_m >= kNear * first_m && sigma_m <= kPlacedSigma * std::min(first_m, last_m);
}

}  // namespace

std::optional<skein::fusion::Estimate> triangulate(std::span<const Bearing> bearings) {
  if (bearings.size() < 2) return std::nullopt;
  const auto begin = nearest_to_lines(bearings);
  if (!begin) return std::nullopt;
  Vector2d emitter = *begin;
  Matrix2d information;
  double distance = 0;
  for (int step = 0; step < kSteps; ++step) {
    information.setZero();
    Vector2d gradient = Vector2d::Zero();
    distance = 0;
    for (const Bearing& bearing : bearings) {
      const Vector2d way = emitter - on_plane(bearing.from);
      const RowVector2d slope = bearing_by_position(way);
      const double weight = 1 / (bearing.sigma_rad * bearing.sigma_rad);
      const double residual = half_turn(bearing.bearing_rad - expected_bearing(way));
      information += weight * slope.transpose() * slope;
      gradient += weight * slope.transpose() * residual;
      distance += way.norm() / static_cast<double>(bearings.size());
    }
    const Vector2d correction = information.ldlt().solve(gradient);
    if (!correction.allFinite() || correction.norm() > distance) return std::nullopt;
    emitter += correction;
    if (correction.norm() < 1e-6 * distance) break;
  }
  for (const Bearing& bearing : bearings) {
    const Vector2d way = emitter - on_plane(bearing.from);
    if (std::abs(half_turn(bearing.bearing_rad - expected_bearing(way))) > std::numbers::pi / 2) {
      return std::nullopt;
    }
  }
  const Matrix2d covariance = information.inverse();
  const double greatest = Eigen::SelfAdjointEigenSolver<Matrix2d>(covariance).eigenvalues().y();
  if (!is_known(emitter, std::sqrt(greatest), bearings)) return std::nullopt;
  return estimate(emitter, covariance);
}

/// What is known of a bearing before it is measured.
struct BearingFilter::Expectation {
  double innovation;
  RowVector2d by_state;
  double share_of_distance;  // that is left from where it is measured
};

BearingFilter::BearingFilter(const Bearing& first, double least_range_m, double greatest_range_m)
    : origin_km_(kKilometres_per_metre * on_plane(first.from)) {
  // Mean and variance of 1 / r, if the logarithm of r is uniform.
  const double near = 1 / (kKilometres_per_metre * least_range_m);
  const double far = 1 / (kKilometres_per_metre * greatest_range_m);
  const double octaves = std::log(near / far);
  const double mean = (near - far) / octaves;
  state_ << first.bearing_rad, mean;
  covariance_ << first.sigma_rad * first.sigma_rad, 0, 0,
      (near * near - far * far) / (2 * octaves) - mean * mean;
}

BearingFilter::Expectation BearingFilter::expect(const Bearing& bearing,
                                                 const Vector2d& state) const {
  // The way to the emitter times the inverse distance: finite however far the emitter is.
  const Vector2d moved_km = kKilometres_per_metre * on_plane(bearing.from) - origin_km_;
  const Vector2d way = direction(state.x()) - state.y() * moved_km;
  Matrix2d way_by_state;
  way_by_state << across(state.x()), -moved_km;
  return {half_turn(bearing.bearing_rad - expected_bearing(way)),
          bearing_by_position(way) * way_by_state, way.norm()};
}

void BearingFilter::update(const Bearing& bearing) {
  const double variance = bearing.sigma_rad * bearing.sigma_rad;
  Vector2d updated = state_;
  Expectation expectation;
  Vector2d gain;
  for (int step = 0; step < kSteps; ++step) {
    expectation = expect(bearing, updated);
    const RowVector2d& slope = expectation.by_state;
    gain = covariance_ * slope.transpose() / (slope * covariance_ * slope.transpose() + variance);
    const Vector2d next = state_ + gain * (expectation.innovation - slope * (state_ - updated));
    const double moved = (next - updated).norm();
    updated = next;
    if (moved < 1e-9) break;
  }
  if (expectation.share_of_distance < kNear) return;
  state_ = updated;
  // Joseph's form keeps it positive definite.
  const Matrix2d rest = Matrix2d::Identity() - gain * expectation.by_state;
  covariance_ = rest * covariance_ * rest.transpose() + variance * gain * gain.transpose();
}

BearingFilter::Innovation BearingFilter::innovation(const Bearing& bearing) const {
  const Expectation expectation = expect(bearing, state_);
  const RowVector2d& slope = expectation.by_state;
  return {expectation.innovation,
          slope * covariance_ * slope.transpose() + bearing.sigma_rad * bearing.sigma_rad};
}

double BearingFilter::relative_range_sigma() const {
  if (state_.y() <= 0) return std::numeric_limits<double>::infinity();
  return std::sqrt(covariance_(1, 1)) / state_.y();
}

skein::fusion::Estimate BearingFilter::position() const {
  const double distance_m = 1 / (kKilometres_per_metre * state_.y());
  Matrix2d by_state;
  by_state << distance_m * across(state_.x()), -distance_m / state_.y() * direction(state_.x());
  return estimate(origin_km_ / kKilometres_per_metre + distance_m * direction(state_.x()),
                  by_state * covariance_ * by_state.transpose());
}

skein::fusion::Estimate BearingFilter::state() const { return estimate(state_, covariance_); }

std::optional<skein::fusion::Estimate> filter_bearings(std::span<const Bearing> bearings,
                                                       double least_range_m,
                                                       double greatest_range_m) {
  BearingFilter filter(bearings.front(), least_range_m, greatest_range_m);
  for (const Bearing& bearing : bearings.subspan(1)) filter.update(bearing);
  const double share = filter.relative_range_sigma();
  if (share > kPlacedSigma) return std::nullopt;
  const skein::fusion::Estimate found = filter.position();
  const Vector2d emitter{found.mean[0], found.mean[1]};
  const double sigma_m = share * (emitter - on_plane(bearings.front().from)).norm();
  if (!is_known(emitter, sigma_m, bearings)) return std::nullopt;
  return found;
}

}  // namespace reconnaissance
