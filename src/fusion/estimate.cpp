#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <string>

#include "matrices.hpp"
#include "skein/error.hpp"
#include "skein/fusion.hpp"

namespace skein::fusion {
namespace {

// What a sender's rounding may leave.
constexpr double kAsymmetry = 1e-9;

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

std::string numbers(std::size_t count) { return std::to_string(count); }

[[noreturn]] void refuse(const char* who, const std::string& why) {
  throw InvalidArgument(std::string(who) + " cannot be fused: " + why);
}

}  // namespace

Gaussian gaussian_of(const Estimate& estimate, const char* who) {
  const std::size_t n = estimate.size();
  if (n == 0) refuse(who, "its mean is empty");
  if (estimate.covariance.size() != n * n) {
    refuse(who, "a mean of " + numbers(n) + " values needs a covariance of " + numbers(n * n) +
                    ", and it has " + numbers(estimate.covariance.size()));
  }
  const auto finite = [](double value) { return std::isfinite(value); };
  if (!std::all_of(estimate.mean.begin(), estimate.mean.end(), finite) ||
      !std::all_of(estimate.covariance.begin(), estimate.covariance.end(), finite)) {
    refuse(who, "a value is not finite");
  }
  const auto size = static_cast<Eigen::Index>(n);
  const RowMajor given = Eigen::Map<const RowMajor>(estimate.covariance.data(), size, size);
  if (!given.isApprox(given.transpose(), kAsymmetry)) {
    refuse(who, "its covariance is not symmetric");
  }
  Gaussian gaussian{Eigen::Map<const Eigen::VectorXd>(estimate.mean.data(), size),
                    (given + given.transpose()) / 2};
  if (Eigen::LLT<Eigen::MatrixXd>(gaussian.covariance).info() != Eigen::Success) {
    refuse(who, "its covariance is not positive definite");
  }
  return gaussian;
}

std::vector<Gaussian> gaussians_of(std::span<const Estimate> estimates) {
  if (estimates.empty()) throw InvalidArgument("there is no estimate to fuse");
  std::vector<Gaussian> gaussians;
  for (const Estimate& estimate : estimates) {
    const std::string who =
        "estimate " + numbers(gaussians.size() + 1) + " of " + numbers(estimates.size());
    if (estimate.size() != estimates.front().size()) {
      refuse(who.c_str(), "it is of " + numbers(estimate.size()) + " quantities, the first is of " +
                              numbers(estimates.front().size()));
    }
    gaussians.push_back(gaussian_of(estimate, who.c_str()));
  }
  return gaussians;
}

Estimate estimate_of(const Gaussian& gaussian) {
  Estimate estimate;
  estimate.mean.assign(gaussian.mean.begin(), gaussian.mean.end());
  const RowMajor symmetric = (gaussian.covariance + gaussian.covariance.transpose()) / 2;
  estimate.covariance.assign(symmetric.data(), symmetric.data() + symmetric.size());
  return estimate;
}

Eigen::MatrixXd inverse(const Eigen::MatrixXd& covariance) {
  return covariance.llt().solve(Eigen::MatrixXd::Identity(covariance.rows(), covariance.cols()));
}

double squared_norm(const Eigen::VectorXd& error, const Eigen::MatrixXd& covariance) {
  return error.dot(covariance.llt().solve(error));
}

void check(const Estimate& estimate, const char* who) { gaussian_of(estimate, who); }

double squared_distance(const Estimate& a, const Estimate& b) {
  const Estimate both[]{a, b};
  const auto gaussians = gaussians_of(both);
  return squared_norm(gaussians[0].mean - gaussians[1].mean,
                      gaussians[0].covariance + gaussians[1].covariance);
}

double nees(const Estimate& estimate, const std::vector<double>& truth) {
  const Gaussian gaussian = gaussian_of(estimate);
  if (truth.size() != estimate.size()) {
    throw InvalidArgument("the truth has " + numbers(truth.size()) + " values, the estimate " +
                          numbers(estimate.size()));
  }
  const auto size = static_cast<Eigen::Index>(truth.size());
  return squared_norm(gaussian.mean - Eigen::Map<const Eigen::VectorXd>(truth.data(), size),
                      gaussian.covariance);
}

double chi_square_quantile(double probability, std::size_t degrees_of_freedom) {
  if (!(probability > 0 && probability < 1) || degrees_of_freedom == 0) {
    throw InvalidArgument("a chi-square quantile needs a probability between 0 and 1, not " +
                          std::to_string(probability) + ", and at least one degree of freedom");
  }
  return boost::math::quantile(boost::math::chi_squared(static_cast<double>(degrees_of_freedom)),
                               probability);
}

}  // namespace skein::fusion
