#pragma once

#include <optional>
#include <string>
#include <vector>

#include "flight/guidance.hpp"
#include "planning/threat_discs.hpp"

// From which circle a moving target is watched. An aircraft cannot be as slow as a vehicle: it
// circles about it at a distance and moves the circle along (the problem of stand-off tracking:
// Frew, Lawrence and Morris, "Coordinated standoff tracking of moving targets using Lyapunov
// guidance vector fields", Journal of Guidance, Control, and Dynamics 31(2), 2008).
namespace reconnaissance {

struct StandOffTask {
  Motion target;    ///< Where it is, and how it moves.
  Motion aircraft;  ///< Only the direction of its motion counts.
  double radius_m = 0;
  double greatest_distance_m = 0;  ///< On the map, from which the target can still be seen.
  double turn_radius_m = 0;        ///< Tighter than which the aircraft does not fly.
  std::vector<ThreatDisc> weapons;
};

/// About where the target will be in a few seconds, in the sense in which the aircraft flies past
/// it already.
Circle circle_about(const StandOffTask& task);

/// The same circle, moved as little as keeps it clear of all weapons; nullopt if the target could
/// not be seen from all of it.
std::optional<Circle> circle_beside(const StandOffTask& task);

/// Why a circle does not serve the task; nullopt if it does.
std::optional<std::string> flaw_of(const Circle& circle, const StandOffTask& task);

/// On which an aircraft waits until threats are known better: about the runway at the origin, so
/// wide that bearings from it cross, and out of reach of all weapons, which it is on the way there,
/// too. nullopt if there is no room for it on the level ground about the runway, or if the aircraft
/// is not there.
std::optional<Circle> waiting_circle(const Local& aircraft, const std::vector<ThreatDisc>& weapons);

/// On the map, from which a pixel is no larger on level ground than that, from a height above it.
double greatest_distance_m(double ground_sample_m, double pixel_rad, double height_m);

}  // namespace reconnaissance
