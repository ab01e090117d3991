#pragma once

#include <span>
#include <vector>

#include "geodesy/local_frame.hpp"
#include "planning/collection_problem.hpp"

namespace reconnaissance {

/// What a weapon reaches on the map, and what it costs to be there.
struct ThreatDisc {
  double north_m = 0;
  double east_m = 0;
  double radius_m = 0;
  double kills_per_s = 0;
};

/// What a weapon is taken to cost within its reach.
inline constexpr double kKills_per_s = 0.02;

/// As far as a weapon may reach whose site is known but for that deviation in the worst direction.
double reach_m(double lethal_range_m, double deviation_m);
/// As far as it reaches in any case.
double certain_reach_m(double lethal_range_m, double deviation_m);

/// ∫ λ dt of a straight flight over all discs that it crosses.
double hazard_of_leg(const Local& from, const Local& to, std::span<const ThreatDisc> discs,
                     double speed_m_s);

/// Of the way over points, in their order.
double hazard_of_way(const std::vector<Local>& way, std::span<const ThreatDisc> discs,
                     double speed_m_s);

/// What is known of an aircraft's flight before it is planned in detail.
struct CruiseFigures {
  double speed_m_s = 60;
  double turn_radius_m = 800;
  double fuel_kg_s = 0.006;
};

/// What it takes to fly from pose to pose: the shortest way without threats, and longer by a way
/// around each disc that it would cross, twice as far as it would have led into it. Hazard there is
/// only where an end lies in a disc, and no way leads around.
FlightCost cost_of_leg(const RoutePose& from, const RoutePose& to,
                       std::span<const ThreatDisc> discs, const CruiseFigures& cruise);

/// How an element is passed for the camera.
struct PassRules {
  double before_m = 3000;  ///< Straight, before the element is abeam: turns onto it die out;
  double after_m = 800;  ///< and after that: the next turn begins as much as 570 m before its end.
  double aside_m = 700;  ///< Of the track from the element.
  int courses = 8;       ///< Past a point.
};

/// Whether a place is within any disc.
bool is_within(const Local& place, std::span<const ThreatDisc> discs);

/// The place itself, or, within a disc, the nearest one outside of it; where discs overlap, outside
/// of all, or as far from them as a few steps lead.
Local out_of_reach(const Local& place, std::span<const ThreatDisc> discs);

/// A road from its middle on, in both directions, as far as it is out of reach; all of it if its
/// middle is not.
std::vector<Local> part_out_of_reach(const std::vector<Local>& line,
                                     std::span<const ThreatDisc> discs);

/// How far aside an emitter is passed: as far as was ordered, and out of reach of its own weapon
/// and of all others that cover it, on whatever course.
double aside_m(const Local& emitter, double ordered_m, std::span<const ThreatDisc> discs);

/// The ways to pass an element straight, with what they take: a point on courses that divide the
/// circle evenly, a road (its corners in order) along its ends, in either direction and on either
/// side.
std::vector<CollectionPass> passes_by(const std::vector<Local>& line,
                                      std::span<const ThreatDisc> discs,
                                      const CruiseFigures& cruise, const PassRules& rules = {});

}  // namespace reconnaissance
