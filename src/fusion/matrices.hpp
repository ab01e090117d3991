#pragma once

#include <Eigen/Dense>
#include <span>

#include "skein/fusion.hpp"

namespace skein::fusion {

/// An estimate as the linear algebra sees it.
struct Gaussian {
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;
};

/// Throws as check() does.
Gaussian gaussian_of(const Estimate& estimate, const char* who = "an estimate");
/// At least one, all of one size.
std::vector<Gaussian> gaussians_of(std::span<const Estimate> estimates);
/// Indices in an order that depends on the values alone. What is computed in this order depends on
/// no other, not even by its rounding.
std::vector<std::size_t> order_of(std::span<const Estimate> estimates);
/// In that order.
std::vector<Gaussian> ordered_gaussians(std::span<const Estimate> estimates);
/// Symmetric to the last bit.
Estimate estimate_of(const Gaussian& gaussian);

Eigen::MatrixXd inverse(const Eigen::MatrixXd& covariance);
double squared_distance(const Gaussian& a, const Gaussian& b);

}  // namespace skein::fusion
