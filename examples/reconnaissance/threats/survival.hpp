#pragma once

#include <cmath>
#include <optional>

#include "random.hpp"
#include "threats/radar.hpp"

namespace reconnaissance {

/// Kills per second that a site threatens an aircraft with: the zone's rate while it guides and the
/// aircraft is in its zone, otherwise 0.
inline double hazard_per_s(const RadarSite& site, RadarMode mode, const Local& aircraft) {
  const bool threatened = mode == RadarMode::Guidance && site.zone.contains(site.antenna, aircraft);
  return threatened ? site.zone.kills_per_s : 0;
}

/// The probability of having survived so far, exp(−∫ λ dt) (Kim and Hespanha, "Discrete
/// approximations to continuous shortest-path: application to minimum-risk path planning for groups
/// of UAVs", 2003).
class Survival {
 public:
  /// A time under a hazard, which is the sum of those of all sites.
  void pass(double hazard_per_s, double seconds) { expected_kills_ += hazard_per_s * seconds; }

  double expected_kills() const { return expected_kills_; }
  double probability() const { return std::exp(-expected_kills_); }

 private:
  double expected_kills_ = 0;
};

/// A site of which it is not known whether and when it appears.
struct PopUp {
  double probability;
  double earliest_s;
  double latest_s;
};

/// When it appears in this run, uniformly between the earliest and the latest; nullopt: it does
/// not. Takes two random numbers in either case, so that what follows does not depend on it.
inline std::optional<double> draw_appearance_s(const PopUp& site, Random& random) {
  const bool appears = random.happens(site.probability);
  const double time_s = std::lerp(site.earliest_s, site.latest_s, random.uniform());
  return appears ? std::optional(time_s) : std::nullopt;
}

/// The probability of surviving a site that is there with a probability, and costs so many expected
/// kills if it is.
inline double survival_if_it_appears(double appearance_probability, double expected_kills) {
  return 1 - appearance_probability * (1 - std::exp(-expected_kills));
}

}  // namespace reconnaissance
