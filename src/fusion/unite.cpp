#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "central_path.hpp"
#include "matrices.hpp"
#include "skein/fusion.hpp"

namespace skein::fusion {
namespace {

/// Matrices (A b), A lower triangular, stand for estimates of mean A⁻¹b and covariance (AᵀA)⁻¹. One
/// covers an estimate of mean x and covariance LLᵀ if no singular value of (A b) K exceeds 1, K =
/// (L x; 0 −1). This is convex, and so is −log det A.
class LeastCover {
 public:
  explicit LeastCover(std::vector<Eigen::MatrixXd> factors)
      : factors_(std::move(factors)), size_(factors_.front().rows() - 1) {
    for (Eigen::Index row = 0; row < size_; ++row) {
      for (Eigen::Index column = 0; column <= row; ++column) free_.emplace_back(row, column);
      free_.emplace_back(row, size_);
    }
  }

  double cost(const Eigen::VectorXd& point, double urge) const {
    const Eigen::MatrixXd cover = matrix_of(point);
    double sum = -urge * cover.diagonal().array().log().sum();
    for (const Eigen::MatrixXd& factor : factors_) {
      const Eigen::LLT<Eigen::MatrixXd> slack = slack_of(cover * factor).llt();
      if (slack.info() != Eigen::Success) return std::numeric_limits<double>::infinity();
      sum -= 2 * slack.matrixLLT().diagonal().array().log().sum();
    }
    return sum;
  }

  Derivatives derivatives(const Eigen::VectorXd& point, double urge) const {
    const Eigen::MatrixXd cover = matrix_of(point);
    const Eigen::Index count = point.size();
    Derivatives result{Eigen::VectorXd::Zero(count), Eigen::MatrixXd::Zero(count, count)};
    for (const Eigen::MatrixXd& factor : factors_) {
      const Eigen::MatrixXd image = cover * factor;
      const Eigen::MatrixXd tension = inverse(slack_of(image));
      const Eigen::MatrixXd slope = factor * image.transpose() * tension;
      const Eigen::MatrixXd bend = factor * factor.transpose() + slope * image * factor.transpose();
      for (Eigen::Index i = 0; i < count; ++i) {
        const auto [row, column] = free_[i];
        result.gradient[i] += 2 * slope(column, row);
        for (Eigen::Index j = 0; j <= i; ++j) {
          const auto [other_row, other_column] = free_[j];
          result.hessian(i, j) += 2 * (tension(row, other_row) * bend(column, other_column) +
                                       slope(column, other_row) * slope(other_column, row));
        }
      }
    }
    for (Eigen::Index i = 0; i < count; ++i) {
      if (free_[i].first != free_[i].second) continue;
      result.gradient[i] -= urge / point[i];
      result.hessian(i, i) += urge / (point[i] * point[i]);
    }
    return result;
  }

  Eigen::VectorXd point_of(const Eigen::MatrixXd& cover) const {
    Eigen::VectorXd point(static_cast<Eigen::Index>(free_.size()));
    for (Eigen::Index i = 0; i < point.size(); ++i) {
      point[i] = cover(free_[i].first, free_[i].second);
    }
    return point;
  }

  Eigen::MatrixXd matrix_of(const Eigen::VectorXd& point) const {
    Eigen::MatrixXd cover = Eigen::MatrixXd::Zero(size_, size_ + 1);
    for (Eigen::Index i = 0; i < point.size(); ++i) {
      cover(free_[i].first, free_[i].second) = point[i];
    }
    return cover;
  }

 private:
  static Eigen::MatrixXd slack_of(const Eigen::MatrixXd& image) {
    return Eigen::MatrixXd::Identity(image.rows(), image.rows()) - image * image.transpose();
  }

  std::vector<Eigen::MatrixXd> factors_;
  Eigen::Index size_;
  std::vector<std::pair<Eigen::Index, Eigen::Index>> free_;  // the entries that are not fixed at 0
};

/// (L x) of each, seen from a mean, in units of the root of a covariance.
std::vector<Eigen::MatrixXd> factors_of(const std::vector<Gaussian>& gaussians,
                                        const Eigen::VectorXd& mean, const Eigen::MatrixXd& root) {
  std::vector<Eigen::MatrixXd> factors;
  for (const Gaussian& each : gaussians) {
    Eigen::MatrixXd factor(mean.size(), mean.size() + 1);
    factor << Eigen::MatrixXd(each.covariance.llt().matrixL()), each.mean - mean;
    factors.emplace_back(root.triangularView<Eigen::Lower>().solve(factor));
  }
  return factors;
}

Gaussian united(std::vector<Gaussian> gaussians) {
  constexpr double kGap = 1e-6;        // in the logarithm of the determinant
  constexpr double kWidening = 1e-10;  // of the spread: what is much narrower cannot be represented
  const Eigen::Index size = gaussians.front().mean.size();
  const auto count = static_cast<double>(gaussians.size());
  Eigen::VectorXd middle = Eigen::VectorXd::Zero(size);
  for (const Gaussian& each : gaussians) middle += each.mean / count;
  Eigen::MatrixXd spread = Eigen::MatrixXd::Zero(size, size);
  for (const Gaussian& each : gaussians) {
    const Eigen::VectorXd away = each.mean - middle;
    spread += (each.covariance + away * away.transpose()) / count;
  }
  const Eigen::VectorXd widening = kWidening * spread.diagonal();
  for (Gaussian& each : gaussians) each.covariance.diagonal() += widening;
  spread.diagonal() += widening;
  const Eigen::MatrixXd root = spread.llt().matrixL();

  std::vector<Eigen::MatrixXd> factors;
  for (const Eigen::MatrixXd& factor : factors_of(gaussians, middle, root)) {
    factors.emplace_back(size + 1, size + 1);
    factors.back() << factor, Eigen::RowVectorXd::Zero(size), -1;
  }
  const LeastCover problem(std::move(factors));
  // Twice their number times the spread covers all.
  const Eigen::VectorXd start =
      problem.point_of(Eigen::MatrixXd::Identity(size, size + 1) / std::sqrt(2 * count));
  const Eigen::MatrixXd cover = problem.matrix_of(
      follow_central_path(problem, start, 2 * count * static_cast<double>(size) / kGap));

  const Eigen::MatrixXd shape = cover.leftCols(size);
  const auto lower = shape.triangularView<Eigen::Lower>();
  const Eigen::VectorXd mean = middle + root * lower.solve(cover.col(size));
  const Eigen::MatrixXd axes =
      root * Eigen::MatrixXd(lower.solve(Eigen::MatrixXd::Identity(size, size)));
  double greatest = 0;
  for (const Eigen::MatrixXd& factor : factors_of(gaussians, mean, axes)) {
    greatest = std::max(greatest, Eigen::JacobiSVD<Eigen::MatrixXd>(factor).singularValues()[0]);
  }
  return {mean, greatest * greatest * axes * axes.transpose()};
}

}  // namespace

Estimate unite(std::span<const Estimate> estimates) {
  return estimate_of(united(ordered_gaussians(estimates)));
}

}  // namespace skein::fusion
