#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <numeric>
#include <sstream>
#include <string>
#include <tuple>

#include "matrices.hpp"
#include "skein/error.hpp"
#include "skein/fusion.hpp"

namespace skein::fusion {
namespace {

// What a sender's rounding may leave, as a share of the two standard deviations.
constexpr double kAsymmetry = 1e-9;
// Between these, no square, quotient or sum of squares leaves the range of double.
constexpr double kGreatestValue = 1e50;
constexpr double kLeastVariance = 1e-100;
constexpr double kGreatestVariance = 1e100;
// Of the correlation matrix. The inverse of one that has less keeps fewer than some four digits.
constexpr double kLeastEigenvalue = 1e-12;
// The series for the quantile converge up to here.
constexpr std::size_t kMostDegreesOfFreedom = 1'000'000;

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

std::string numbers(std::size_t count) { return std::to_string(count); }

std::string text(double value) {
  std::ostringstream stream;
  stream << value;
  return stream.str();
}

[[noreturn]] void refuse(const char* who, const std::string& why) {
  throw InvalidArgument(std::string(who) + " cannot be fused: " + why);
}

Eigen::VectorXd vector_of(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

void check_means(const std::vector<double>& means, const char* who) {
  for (std::size_t i = 0; i < means.size(); ++i) {
    if (std::abs(means[i]) <= kGreatestValue) continue;
    refuse(who, "its mean [" + numbers(i) + "] is " + text(means[i]) +
                    ", and its size must be at most " + text(kGreatestValue) +
                    ": use a larger unit");
  }
}

void check_variances(const Eigen::VectorXd& variances, const char* who) {
  for (Eigen::Index i = 0; i < variances.size(); ++i) {
    if (variances[i] <= 0) {
      refuse(who, "its covariance is not positive definite: variance [" + std::to_string(i) +
                      "] is " + text(variances[i]));
    }
    if (variances[i] >= kLeastVariance && variances[i] <= kGreatestVariance) continue;
    refuse(who, "its variance [" + std::to_string(i) + "] is " + text(variances[i]) +
                    ", and must be between " + text(kLeastVariance) + " and " +
                    text(kGreatestVariance) + ": use a unit of another size");
  }
}

double squared_norm(const Eigen::VectorXd& error, const Eigen::MatrixXd& covariance) {
  return error.dot(covariance.llt().solve(error));
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
  check_means(estimate.mean, who);
  check_variances(given.diagonal(), who);
  const Eigen::VectorXd scale = given.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd correlation = scale.asDiagonal() * given * scale.asDiagonal();
  if (!(correlation.cwiseAbs().maxCoeff() <= 1 + kAsymmetry)) {
    refuse(who, "its covariance is not positive definite");
  }
  if ((correlation - correlation.transpose()).cwiseAbs().maxCoeff() > kAsymmetry) {
    refuse(who, "its covariance is not symmetric");
  }
  const double least = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(
                           (correlation + correlation.transpose()) / 2, Eigen::EigenvaluesOnly)
                           .eigenvalues()[0];
  if (!(least > 0)) refuse(who, "its covariance is not positive definite");
  if (least < kLeastEigenvalue) {
    refuse(who,
           "its covariance is too near to singular: the least eigenvalue of its correlation matrix "
           "is " +
               text(least) + ", and must be at least " + text(kLeastEigenvalue) +
               "; leave out a quantity that follows from the others, or enlarge the variances");
  }
  return {vector_of(estimate.mean), (given + given.transpose()) / 2};
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

std::vector<std::size_t> order_of(std::span<const Estimate> estimates) {
  std::vector<std::size_t> order(estimates.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::tie(estimates[a].mean, estimates[a].covariance) <
           std::tie(estimates[b].mean, estimates[b].covariance);
  });
  return order;
}

std::vector<Gaussian> ordered_gaussians(std::span<const Estimate> estimates) {
  const auto given = gaussians_of(estimates);
  std::vector<Gaussian> gaussians;
  for (const std::size_t i : order_of(estimates)) gaussians.push_back(given[i]);
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

double squared_distance(const Gaussian& a, const Gaussian& b) {
  return squared_norm(a.mean - b.mean, a.covariance + b.covariance);
}

void check(const Estimate& estimate, const char* who) { gaussian_of(estimate, who); }

double squared_distance(const Estimate& a, const Estimate& b) {
  const Estimate both[]{a, b};
  const auto gaussians = gaussians_of(both);
  return squared_distance(gaussians[0], gaussians[1]);
}

double nees(const Estimate& estimate, const std::vector<double>& truth) {
  const Gaussian gaussian = gaussian_of(estimate);
  if (truth.size() != estimate.size()) {
    throw InvalidArgument("the truth has " + numbers(truth.size()) + " values, the estimate " +
                          numbers(estimate.size()));
  }
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (std::abs(truth[i]) <= kGreatestValue) continue;
    throw InvalidArgument("value [" + numbers(i) + "] of the truth is " + text(truth[i]) +
                          "; its size must be at most " + text(kGreatestValue));
  }
  return squared_norm(gaussian.mean - vector_of(truth), gaussian.covariance);
}

double chi_square_quantile(double probability, std::size_t degrees_of_freedom) {
  if (!(probability > 0 && probability < 1) || degrees_of_freedom == 0 ||
      degrees_of_freedom > kMostDegreesOfFreedom) {
    throw InvalidArgument("a chi-square quantile needs a probability between 0 and 1, not " +
                          text(probability) + ", and 1 to " + numbers(kMostDegreesOfFreedom) +
                          " degrees of freedom, not " + numbers(degrees_of_freedom));
  }
  return boost::math::quantile(boost::math::chi_squared(static_cast<double>(degrees_of_freedom)),
                               probability);
}

}  // namespace skein::fusion
