#include "planning/threat_discs.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "mission/elements.hpp"

namespace reconnaissance {
namespace {

/// How a segment lies to a disc.
struct Crossing {
  double inside_m;   ///< So much of it lies in the disc.
  double nearest_m;  ///< To the disc's centre.
};

Crossing crossing(const Local& from, const Local& to, const ThreatDisc& disc) {
  const double north = to.north_m - from.north_m, east = to.east_m - from.east_m;
  const double length = std::hypot(north, east);
  const double to_centre_north = disc.north_m - from.north_m;
  const double to_centre_east = disc.east_m - from.east_m;
  if (length == 0) return {0, std::hypot(to_centre_north, to_centre_east)};
  const double along = (to_centre_north * north + to_centre_east * east) / length;
  const double aside = (to_centre_east * north - to_centre_north * east) / length;
  const double clamped = std::clamp(along, 0.0, length);
  const double nearest = std::hypot(aside, along - clamped);
  const double squared = disc.radius_m * disc.radius_m - aside * aside;
  if (squared <= 0) return {0, nearest};
  const double half = std::sqrt(squared);
  return {std::max(0.0, std::min(length, along + half) - std::max(0.0, along - half)), nearest};
}

template <class Place>
bool contains(const ThreatDisc& disc, const Place& place) {
  return map_distance_m(disc, place) < disc.radius_m;
}

Local place(const RoutePose& pose) { return {pose.north_m, pose.east_m, 0}; }

/// Straight past a middle that reaches `half_m` to both sides, with it so far to the left.
CollectionPass straight_past(const Local& middle, double half_m, double course_rad, double aside_m,
                             std::span<const ThreatDisc> discs, const CruiseFigures& cruise,
                             const PassRules& rules) {
  const double north = std::cos(course_rad), east = std::sin(course_rad);
  const auto at = [&](double along_m) {
    return RoutePose{middle.north_m + along_m * north - aside_m * east,
                     middle.east_m + along_m * east + aside_m * north, course_rad};
  };
  CollectionPass pass{at(-half_m - rules.before_m), at(half_m + rules.after_m), {}};
  pass.cost.seconds = (2 * half_m + rules.before_m + rules.after_m) / cruise.speed_m_s;
  pass.cost.fuel_kg = pass.cost.seconds * cruise.fuel_kg_s;
  pass.cost.hazard = hazard_of_leg(place(pass.begin), place(pass.end), discs, cruise.speed_m_s);
  return pass;
}

// A site that is badly placed may be anywhere within so many deviations.
constexpr double kPlacedWithin = 2;

}  // namespace

double reach_m(double lethal_range_m, double deviation_m) {
  constexpr double kFurthestOff_m = 1500;
  return lethal_range_m + std::min(kPlacedWithin * deviation_m, kFurthestOff_m);
}

double certain_reach_m(double lethal_range_m, double deviation_m) {
  return std::max(lethal_range_m - kPlacedWithin * deviation_m, 0.0);
}

double hazard_of_leg(const Local& from, const Local& to, std::span<const ThreatDisc> discs,
                     double speed_m_s) {
  double hazard = 0;
  for (const ThreatDisc& disc : discs)
    hazard += disc.kills_per_s * crossing(from, to, disc).inside_m / speed_m_s;
  return hazard;
}

double hazard_of_way(const std::vector<Local>& way, std::span<const ThreatDisc> discs,
                     double speed_m_s) {
  double hazard = 0;
  for (std::size_t i = 1; i < way.size(); ++i)
    hazard += hazard_of_leg(way[i - 1], way[i], discs, speed_m_s);
  return hazard;
}

FlightCost cost_of_leg(const RoutePose& from, const RoutePose& to,
                       std::span<const ThreatDisc> discs, const CruiseFigures& cruise) {
  double length_m = dubins_length_m(from, to, cruise.turn_radius_m);
  FlightCost cost;
  for (const ThreatDisc& disc : discs) {
    const Crossing found = crossing(place(from), place(to), disc);
    if (found.inside_m == 0) continue;
    if (contains(disc, from) || contains(disc, to))
      cost.hazard += disc.kills_per_s * found.inside_m / cruise.speed_m_s;
    else
      length_m += 2 * (disc.radius_m - found.nearest_m);
  }
  cost.seconds = length_m / cruise.speed_m_s;
  cost.fuel_kg = cost.seconds * cruise.fuel_kg_s;
  return cost;
}

bool is_within(const Local& place, std::span<const ThreatDisc> discs) {
  return std::ranges::any_of(discs, [&](const ThreatDisc& disc) { return contains(disc, place); });
}

Local out_of_reach(const Local& place, std::span<const ThreatDisc> discs) {
  constexpr int kSteps = 20;
  constexpr double kBeside_m = 1;
  Local out = place;
  for (int step = 0; step < kSteps; ++step) {
    const auto disc =
        std::ranges::find_if(discs, [&](const ThreatDisc& each) { return contains(each, out); });
    if (disc == discs.end()) break;
    // From its very middle all ways are as long.
    const double away_rad = course_between_rad(*disc, out);
    out.north_m = disc->north_m + (disc->radius_m + kBeside_m) * std::cos(away_rad);
    out.east_m = disc->east_m + (disc->radius_m + kBeside_m) * std::sin(away_rad);
  }
  return out;
}

std::vector<Local> part_out_of_reach(const std::vector<Local>& line,
                                     std::span<const ThreatDisc> discs) {
  constexpr double kSpacing_m = 100;
  const auto places = parts_of_line(line, kSpacing_m);
  const auto is_in = [&](const Local& place) { return is_within(place, discs); };
  const auto middle = places.begin() + static_cast<std::ptrdiff_t>(places.size() / 2);
  const auto first = std::find_if(std::reverse_iterator(middle), places.rend(), is_in).base();
  const auto last = std::find_if(middle, places.end(), is_in);
  if (last - first < 2) return line;
  return {first, last};
}

double aside_m(const Local& emitter, double ordered_m, std::span<const ThreatDisc> discs) {
  // A way along the very edge would be within it by its wind.
  constexpr double kBeside_m = 200;
  double aside = ordered_m;
  for (const ThreatDisc& disc : discs) {
    if (!contains(disc, emitter)) continue;
    const double off = map_distance_m(disc, emitter);
    aside = std::max(aside, disc.radius_m + off + kBeside_m);
  }
  return aside;
}

std::vector<CollectionPass> passes_by(const std::vector<Local>& line,
                                      std::span<const ThreatDisc> discs,
                                      const CruiseFigures& cruise, const PassRules& rules) {
  std::vector<CollectionPass> passes;
  if (line.size() < 2) {
    for (int i = 0; i < rules.courses; ++i)
      passes.push_back(straight_past(line.front(), 0, 2 * std::numbers::pi * i / rules.courses,
                                     rules.aside_m, discs, cruise, rules));
    return passes;
  }
  const Local& a = line.front();
  const Local& b = line.back();
  const Local middle{(a.north_m + b.north_m) / 2, (a.east_m + b.east_m) / 2, 0};
  const double half_m = map_distance_m(b, a) / 2;
  const double along_rad = course_between_rad(a, b);
  for (const double course_rad : {along_rad, along_rad + std::numbers::pi})
    for (const double aside_m : {rules.aside_m, -rules.aside_m})
      passes.push_back(straight_past(middle, half_m, course_rad, aside_m, discs, cruise, rules));
  return passes;
}

}  // namespace reconnaissance
