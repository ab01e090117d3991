#pragma once

#include <span>
#include <vector>

#include "skein/fusion/estimate.hpp"

// One estimate of several of the same quantities. Which one: by what is known of how their errors
// hang together. Wrongly taken for independent, errors that share a cause are counted twice, and
// the result is surer of itself than it may be. All of these throw InvalidArgument for no
// estimates, for estimates of different sizes, and as check() does. Thread-safe: functions of their
// arguments alone.
namespace skein::fusion {

/// Errors are independent: P⁻¹ = Σ Pᵢ⁻¹, x = P Σ Pᵢ⁻¹ xᵢ (information filter).
Estimate fuse_independent(std::span<const Estimate> estimates);

/// What an intersection makes as small as it can.
enum class Measure { Determinant, Trace };

struct Intersection {
  Estimate fused;
  std::vector<double> weights;  ///< One for each estimate; together 1.
};

/// Nothing is known of how the errors correlate, as after a data link on which tracks may come back
/// to who sent them. Covariance intersection: P⁻¹ = Σ ωᵢ Pᵢ⁻¹, x = P Σ ωᵢ Pᵢ⁻¹ xᵢ, with the weights
/// that minimise the measure of P. Consistent for every correlation if the estimates are (Julier
/// and Uhlmann 1997). The weights by the multiplicative algorithm of optimal design (Silvey,
/// Titterington and Torsney 1978).
Intersection intersect(std::span<const Estimate> estimates, Measure measure = Measure::Determinant);

/// Some of the estimates may be wrong, and nobody knows which: covariance union (Uhlmann 2003).
/// Covers Pᵢ + (x − xᵢ)(x − xᵢ)ᵀ of each. Of two, by the least determinant for its mean x; of more,
/// one after the other, which is not always the least. The mean is sought from the middle of all
/// towards each.
Estimate unite(std::span<const Estimate> estimates);

/// Intersects the estimates while they agree, each new one with the result so far by a chi-square
/// gate of that probability; where one does not agree, unites all. An estimate is thrown out by
/// neither.
Estimate fuse_cautiously(std::span<const Estimate> estimates, double gate_probability = 0.99);

}  // namespace skein::fusion
