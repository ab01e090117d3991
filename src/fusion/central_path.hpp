#pragma once

#include <Eigen/Dense>

namespace skein::fusion {

struct Derivatives {
  Eigen::VectorXd gradient;
  Eigen::MatrixXd hessian;  ///< Its lower triangle.
};

/// One Newton step, shortened until it pays; returns what a full step promised, and 0 if none pays.
template <typename Problem>
double improve(const Problem& problem, Eigen::VectorXd& point, double urge) {
  constexpr double kLeastShare = 1e-6;
  const Derivatives here = problem.derivatives(point, urge);
  const Eigen::VectorXd step = -here.hessian.llt().solve(here.gradient);
  const double promise = -here.gradient.dot(step) / 2;
  const double cost = problem.cost(point, urge);
  for (double share = 1; share > kLeastShare; share /= 2) {
    const Eigen::VectorXd next = point + share * step;
    if (problem.cost(next, urge) < cost - share * promise / 4) {
      point = next;
      return promise;
    }
  }
  return 0;
}

/// Minimises a convex function within barriers: cost(point, urge) is urge times the function plus
/// the barriers, and not finite beyond them. The minimum for an urge exceeds the least by at most
/// the barriers' parameter divided by the urge (Nesterov and Nemirovskii 1994). Begins at a point
/// within and stays within.
template <typename Problem>
Eigen::VectorXd follow_central_path(const Problem& problem, Eigen::VectorXd point,
                                    double greatest_urge) {
  constexpr double kGrowth = 10;
  constexpr double kCentred = 1e-3;
  constexpr int kMaxSteps = 50;
  for (double urge = 1; urge < kGrowth * greatest_urge; urge *= kGrowth) {
    for (int step = 0; step < kMaxSteps; ++step) {
      if (!(improve(problem, point, urge) > kCentred)) break;
    }
  }
  return point;
}

}  // namespace skein::fusion
