#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <limits>

#include "matrices.hpp"
#include "skein/fusion.hpp"

namespace skein::fusion {
namespace {

/// What estimates say, weighted: the inverse of a covariance, and that by the mean.
struct Information {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd vector;

  explicit Information(Eigen::Index size)
      : matrix(Eigen::MatrixXd::Zero(size, size)), vector(Eigen::VectorXd::Zero(size)) {}

  void add(const Gaussian& gaussian, double weight) {
    const Eigen::MatrixXd information = inverse(gaussian.covariance);
    matrix += weight * information;
    vector += weight * information * gaussian.mean;
  }

  Gaussian gaussian() const {
    const Eigen::MatrixXd covariance = inverse(matrix);
    return {covariance * vector, covariance};
  }
};

Gaussian weighted(const std::vector<Gaussian>& gaussians, const std::vector<double>& weights) {
  Information information(gaussians.front().mean.size());
  for (std::size_t i = 0; i < gaussians.size(); ++i) information.add(gaussians[i], weights[i]);
  return information.gaussian();
}

/// How fast the measure falls as the weight of what has this information grows, as a share of how
/// fast it falls as all weights grow: 1 for each that has a weight, at the optimum, and at most 1
/// for the others.
double merit(const Eigen::MatrixXd& information, const Eigen::MatrixXd& covariance,
             Measure measure) {
  if (measure == Measure::Determinant) {
    return (covariance * information).trace() / static_cast<double>(covariance.rows());
  }
  return (covariance * information * covariance).trace() / covariance.trace();
}

std::vector<double> best_weights(const std::vector<Gaussian>& gaussians, Measure measure) {
  constexpr double kMeritLeft = 1e-10;
  constexpr int kMaxSteps = 10'000;  // whatever the weights are then, the result is consistent
  std::vector<Eigen::MatrixXd> informations;
  for (const Gaussian& gaussian : gaussians) informations.push_back(inverse(gaussian.covariance));
  std::vector<double> weights(gaussians.size(), 1.0 / static_cast<double>(gaussians.size()));
  for (int step = 0; step < kMaxSteps; ++step) {
    Eigen::MatrixXd sum = weights[0] * informations[0];
    for (std::size_t i = 1; i < weights.size(); ++i) sum += weights[i] * informations[i];
    const Eigen::MatrixXd covariance = inverse(sum);
    double greatest = 0, total = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      const double own = merit(informations[i], covariance, measure);
      greatest = std::max(greatest, own);
      weights[i] *= measure == Measure::Determinant ? own : std::sqrt(own);
      total += weights[i];
    }
    for (double& weight : weights) weight /= total;
    if (greatest - 1 < kMeritLeft) break;
  }
  return weights;
}

/// The least matrix that exceeds both: a and b brought to diagonal form by one transformation,
/// there the greater of each.
Eigen::MatrixXd upper_bound(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  const Eigen::MatrixXd root = b.llt().matrixL();
  const auto lower = root.triangularView<Eigen::Lower>();
  const Eigen::MatrixXd half = lower.solve(a);
  const Eigen::MatrixXd relative = lower.solve(half.transpose());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver((relative + relative.transpose()) /
                                                              2);
  const Eigen::MatrixXd axes = root * solver.eigenvectors();
  return axes * solver.eigenvalues().cwiseMax(1.0).asDiagonal() * axes.transpose();
}

/// The least that covers all of them about that mean, one after the other.
Gaussian covering(const std::vector<Gaussian>& gaussians, const Eigen::VectorXd& mean) {
  const auto about = [&](const Gaussian& each) -> Eigen::MatrixXd {
    const Eigen::VectorXd away = mean - each.mean;
    return each.covariance + away * away.transpose();
  };
  Eigen::MatrixXd covariance = about(gaussians.front());
  for (std::size_t i = 1; i < gaussians.size(); ++i) {
    covariance = upper_bound(covariance, about(gaussians[i]));
  }
  return {mean, covariance};
}

double log_determinant(const Eigen::MatrixXd& covariance) {
  return 2 * covariance.llt().matrixLLT().diagonal().array().log().sum();
}

// From the middle of all towards each mean in turn, as far as the determinant falls.
Gaussian united(const std::vector<Gaussian>& gaussians) {
  constexpr int kBits = std::numeric_limits<double>::digits / 2;
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(gaussians.front().mean.size());
  for (const Gaussian& each : gaussians) mean += each.mean / static_cast<double>(gaussians.size());
  for (const Gaussian& each : gaussians) {
    const Eigen::VectorXd way = each.mean - mean;
    const auto cost = [&](double share) {
      return log_determinant(covering(gaussians, mean + share * way).covariance);
    };
    const auto [share, least] = boost::math::tools::brent_find_minima(cost, 0.0, 1.0, kBits);
    if (least < cost(0)) mean += share * way;
  }
  return covering(gaussians, mean);
}

}  // namespace

Estimate fuse_independent(std::span<const Estimate> estimates) {
  const auto gaussians = gaussians_of(estimates);
  return estimate_of(weighted(gaussians, std::vector<double>(gaussians.size(), 1.0)));
}

Intersection intersect(std::span<const Estimate> estimates, Measure measure) {
  const auto gaussians = gaussians_of(estimates);
  auto weights = best_weights(gaussians, measure);
  return {estimate_of(weighted(gaussians, weights)), std::move(weights)};
}

Estimate unite(std::span<const Estimate> estimates) {
  return estimate_of(united(gaussians_of(estimates)));
}

Estimate fuse_cautiously(std::span<const Estimate> estimates, double gate_probability) {
  const double gate =
      chi_square_quantile(gate_probability, gaussians_of(estimates).front().mean.size());
  for (std::size_t i = 1; i < estimates.size(); ++i) {
    const Estimate so_far = intersect(estimates.first(i)).fused;
    if (squared_distance(so_far, estimates[i]) > gate) return unite(estimates);
  }
  return intersect(estimates).fused;
}

}  // namespace skein::fusion
