#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "skein/detail/version.hpp"

// Makes one estimate from several of the same quantities. Which function fits depends on what is
// known about the correlation of their errors: errors with a common cause that are taken for
// independent are counted twice, and the result is overconfident. All functions throw
// InvalidArgument for no estimates, for estimates of different sizes, and as check() does. What
// they return is finite, and its covariance positive definite. It does not depend on the order of
// the estimates, to the last bit. Thread-safe: they depend on their arguments alone.
namespace skein::fusion {

/// A source's estimate of n quantities: their mean and the covariance of its error.
struct Estimate {
  std::vector<double> mean;        ///< n values.
  std::vector<double> covariance;  ///< n × n, row-major; symmetric, positive definite.

  std::size_t size() const noexcept { return mean.size(); }
  bool operator==(const Estimate&) const = default;
};

/// Throws InvalidArgument if the sizes do not match, a value is not finite, or the covariance is
/// not symmetric and positive definite. What double cannot compute with is refused, too: a mean of
/// a size above 1e50, a variance outside 1e-100 to 1e100, and a correlation matrix with an
/// eigenvalue below 1e-12. `who` names the estimate in the text.
void check(const Estimate& estimate, const char* who);

/// Squared Mahalanobis distance of two estimates of the same quantities, (a − b)ᵀ (A + B)⁻¹ (a −
/// b). For consistent estimates with independent errors it is chi-square distributed with n degrees
/// of freedom.
double squared_distance(const Estimate& a, const Estimate& b);

/// Normalised estimation error squared (NEES) of an estimate whose truth is known, (x − truth)ᵀ P⁻¹
/// (x − truth). If the covariance is correct, it is chi-square distributed with n degrees of
/// freedom. Throws InvalidArgument as check() does, or if `truth` has another size, a value that is
/// not finite, or one of a size above 1e50.
double nees(const Estimate& estimate, const std::vector<double>& truth);

/// The value that a chi-square distributed variable exceeds with probability 1 − `probability`.
/// Throws InvalidArgument if `probability` is not between 0 and 1, both exclusive, and for 0 or
/// more than a million degrees of freedom.
double chi_square_quantile(double probability, std::size_t degrees_of_freedom);

/// For independent errors: P⁻¹ = Σ Pᵢ⁻¹, x = P Σ Pᵢ⁻¹ xᵢ (information filter).
Estimate fuse_independent(std::span<const Estimate> estimates);

/// What intersect() minimises.
enum class Measure { Determinant, Trace };

struct Intersection {
  Estimate fused;
  std::vector<double> weights;  ///< One per estimate; their sum is 1.
};

/// For errors whose correlation is unknown, for example after a data link that may return tracks to
/// their sender. Covariance intersection: P⁻¹ = Σ ωᵢ Pᵢ⁻¹, x = P Σ ωᵢ Pᵢ⁻¹ xᵢ, with the weights
/// that minimise the measure of P. Consistent for every correlation if the estimates are (Julier
/// and Uhlmann 1997). All weights are found together, so that the measure is the least to 1e-6 of
/// it; to 1e-3, if correlation matrices have eigenvalues below 1e-9. For the least determinant,
/// tr(P Pᵢ⁻¹) ≤ n for each (Kiefer and Wolfowitz 1960). An estimate without use has a weight near
/// 0, not 0.
Intersection intersect(std::span<const Estimate> estimates, Measure measure = Measure::Determinant);

/// For estimates of which some may be wrong, and it is unknown which: covariance union (Uhlmann
/// 2003). The result covers Pᵢ + (x − xᵢ)(x − xᵢ)ᵀ of each. Of all that do, it has the least
/// determinant of P, to 1e-6 of its logarithm; x and P are found together (as the least ellipsoid
/// about ellipsoids: Boyd and Vandenberghe 2004, 8.4.1). Before that, each variance is widened by
/// 1e-10 of the spread of all estimates in that quantity. The time grows with n⁶: milliseconds up
/// to n = 10, 0.4 s for three estimates of n = 30.
Estimate unite(std::span<const Estimate> estimates);

/// Intersects the estimates if they agree; otherwise unites all. No estimate is discarded. They
/// agree if each pair passes a chi-square gate of that probability (0 to 1, both exclusive): its
/// squared_distance() is at most the quantile for n degrees of freedom.
Estimate fuse_cautiously(std::span<const Estimate> estimates, double gate_probability = 0.99);

}  // namespace skein::fusion
