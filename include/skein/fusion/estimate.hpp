#pragma once

#include <cstddef>
#include <vector>

namespace skein::fusion {

/// What a source believes of n quantities: their mean, and the covariance of its error.
struct Estimate {
  std::vector<double> mean;        ///< n values.
  std::vector<double> covariance;  ///< n × n, row after row; symmetric, positive definite.

  std::size_t size() const noexcept { return mean.size(); }
  bool operator==(const Estimate&) const = default;
};

/// Throws InvalidArgument where the sizes do not fit, a value is not finite, or the covariance is
/// not symmetric and positive definite; `who` names the estimate in the text.
void check(const Estimate& estimate, const char* who);

/// Squared Mahalanobis distance of two estimates of the same quantities, (a − b)ᵀ (A + B)⁻¹ (a −
/// b): for consistent ones with independent errors it is chi-square distributed with n degrees of
/// freedom. Throws InvalidArgument as check() does.
double squared_distance(const Estimate& a, const Estimate& b);

/// Normalised estimation error squared (NEES) of an estimate whose truth is known, (x − truth)ᵀ P⁻¹
/// (x − truth): chi-square distributed with n degrees of freedom where the covariance tells the
/// truth. Throws InvalidArgument as check() does, or where `truth` has another size.
double nees(const Estimate& estimate, const std::vector<double>& truth);

/// The value that a chi-square distributed one exceeds with the probability 1 − `probability`.
/// Throws InvalidArgument for a probability outside of 0 to 1, both exclusive, and for no degrees
/// of freedom.
double chi_square_quantile(double probability, std::size_t degrees_of_freedom);

}  // namespace skein::fusion
