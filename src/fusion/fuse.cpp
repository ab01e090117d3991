#include <cmath>
#include <limits>

#include "central_path.hpp"
#include "matrices.hpp"
#include "skein/fusion.hpp"

namespace skein::fusion {
namespace {

/// Of the sum of the weighted informations.
Gaussian weighted(const std::vector<Gaussian>& gaussians, const std::vector<double>& weights) {
  const auto size = gaussians.front().mean.size();
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(size, size);
  for (std::size_t i = 0; i < gaussians.size(); ++i) {
    sum += weights[i] * inverse(gaussians[i].covariance);
  }
  const Eigen::MatrixXd covariance = inverse(sum);
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(size);
  for (int pass = 0; pass < 2; ++pass) {  // the second regains what the size of the means has cost
    Eigen::VectorXd pull = Eigen::VectorXd::Zero(size);
    for (std::size_t i = 0; i < gaussians.size(); ++i) {
      pull += weights[i] * gaussians[i].covariance.llt().solve(gaussians[i].mean - mean);
    }
    mean += covariance * pull;
  }
  return {mean, covariance};
}

double log_determinant(const Eigen::MatrixXd& matrix) {
  return 2 * matrix.llt().matrixLLT().diagonal().array().log().sum();
}

/// The logarithm of the measure, per degree, plus the sum of the weights: its minimum has the
/// weights that are best for their sum.
class Weighting {
 public:
  Weighting(const std::vector<Gaussian>& gaussians, Measure measure) : measure_(measure) {
    const Eigen::Index size = gaussians.front().mean.size();
    const auto unit = Eigen::MatrixXd::Identity(size, size);
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(size, size);
    for (const Gaussian& each : gaussians) sum += inverse(each.covariance);
    // In units of the sum of all, nearly singular covariances lose no digits.
    const Eigen::MatrixXd root = sum.llt().matrixL();
    const auto lower = root.triangularView<Eigen::Lower>();
    for (const Gaussian& each : gaussians) {
      const Eigen::MatrixXd own = each.covariance.llt().matrixU().solve(unit);
      const Eigen::MatrixXd factor = lower.solve(own);
      informations_.emplace_back(factor * factor.transpose());
    }
    const Eigen::MatrixXd back = lower.solve(unit);
    metric_ = back * back.transpose();
  }

  double cost(const Eigen::VectorXd& weights, double urge) const {
    if (!(weights.minCoeff() > 0)) return std::numeric_limits<double>::infinity();
    const Eigen::MatrixXd sum = total(weights);
    const double size = measure_ == Measure::Determinant
                            ? -log_determinant(sum) / static_cast<double>(sum.rows())
                            : std::log((inverse(sum) * metric_).trace());
    return urge * (size + weights.sum()) - weights.array().log().sum();
  }

  Derivatives derivatives(const Eigen::VectorXd& weights, double urge) const {
    const Eigen::Index count = weights.size();
    const Eigen::MatrixXd covariance = inverse(total(weights));
    const bool trace = measure_ == Measure::Trace;
    const Eigen::MatrixXd measured = covariance * metric_;
    const double size = trace ? measured.trace() : static_cast<double>(covariance.rows());
    std::vector<Eigen::MatrixXd> shares, merits;
    for (const Eigen::MatrixXd& information : informations_) {
      shares.emplace_back(covariance * information);
      merits.emplace_back(trace ? shares.back() * measured : shares.back());
    }
    Derivatives result{Eigen::VectorXd(count), Eigen::MatrixXd(count, count)};
    for (Eigen::Index i = 0; i < count; ++i) {
      const double merit = merits[i].trace() / size;
      result.gradient[i] = urge * (1 - merit) - 1 / weights[i];
      for (Eigen::Index j = 0; j <= i; ++j) {
        const double both = shares[i].cwiseProduct(merits[j].transpose()).sum() / size;
        result.hessian(i, j) = urge * (trace ? 2 * both - merit * merits[j].trace() / size : both);
      }
      result.hessian(i, i) += 1 / (weights[i] * weights[i]);
    }
    return result;
  }

 private:
  Eigen::MatrixXd total(const Eigen::VectorXd& weights) const {
    Eigen::MatrixXd sum = weights[0] * informations_[0];
    for (Eigen::Index i = 1; i < weights.size(); ++i) sum += weights[i] * informations_[i];
    return sum;
  }

  Measure measure_;
  std::vector<Eigen::MatrixXd> informations_;
  Eigen::MatrixXd metric_;  // the trace of a covariance times this is its trace in given units
};

std::vector<double> best_weights(const std::vector<Gaussian>& gaussians, Measure measure) {
  constexpr double kMeritLeft = 1e-9;
  const auto count = static_cast<double>(gaussians.size());
  const Eigen::VectorXd even =
      Eigen::VectorXd::Constant(static_cast<Eigen::Index>(gaussians.size()), 1 / count);
  const Eigen::VectorXd best =
      follow_central_path(Weighting(gaussians, measure), even, count / kMeritLeft);
  const Eigen::VectorXd weights = best / best.sum();
  return {weights.begin(), weights.end()};
}

}  // namespace

Estimate fuse_independent(std::span<const Estimate> estimates) {
  const auto gaussians = ordered_gaussians(estimates);
  return estimate_of(weighted(gaussians, std::vector<double>(gaussians.size(), 1.0)));
}

Intersection intersect(std::span<const Estimate> estimates, Measure measure) {
  const auto gaussians = ordered_gaussians(estimates);
  const auto weights = best_weights(gaussians, measure);
  Intersection intersection{estimate_of(weighted(gaussians, weights)),
                            std::vector<double>(weights.size())};
  const auto order = order_of(estimates);
  for (std::size_t i = 0; i < order.size(); ++i) intersection.weights[order[i]] = weights[i];
  return intersection;
}

Estimate fuse_cautiously(std::span<const Estimate> estimates, double gate_probability) {
  const auto gaussians = gaussians_of(estimates);
  const double gate = chi_square_quantile(gate_probability, gaussians.front().mean.size());
  for (std::size_t i = 1; i < gaussians.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (squared_distance(gaussians[i], gaussians[j]) > gate) return unite(estimates);
    }
  }
  return intersect(estimates).fused;
}

}  // namespace skein::fusion
