#include "navigation/planners/planning_scene.hpp"

#include <algorithm>
#include <cmath>

#include "navigation/planners/problem_rules.hpp"
#include "skein/error.hpp"

namespace skein::navigation {
namespace {

/// Metres that planners keep from a zone beyond what the Problem asks, for rounding and for taste.
constexpr double kBuffer_m = 20;

/// A turn of 60 degrees comes this share of its radius closer than its corner.
constexpr double kOfTurnRadius = 0.16;

/// The buffer must not swallow a start or goal that is close to a zone, but outside.
double buffer_for(const AE_navigator::NoFlyZone& zone, const AE_navigator::Problem& problem,
                  double wanted_m) {
  const KeepOut exact(zone, 0);
  const double nearest =
      std::min(exact.distance_m(on_map(problem.start)), exact.distance_m(on_map(problem.goal)));
  return nearest > 0 ? std::min(wanted_m, nearest / 2) : kBuffer_m;
}

}  // namespace

std::shared_ptr<const Terrain> load_valid(TerrainProvider& terrains,
                                          const AE_navigator::Problem& problem) {
  try {
    auto terrain = terrains.load(problem.terrain);
    require_valid(problem, *terrain);
    return terrain;
  } catch (const InvalidArgument& error) {
    throw AE_navigator::InvalidProblem(error.what());
  }
}

PlanningScene::PlanningScene(const Search& search)
    : terrain_(load_valid(search.terrains, search.problem)),
      problem_(search.problem),
      budget_(search.options, problem_.time_limit_ms),
      surface_(*terrain_, problem_, PlanningGrid(*terrain_, search.options.grid_spacing_m)) {
  for (const auto& zone : problem_.no_fly_zones) {
    for (const Berth berth : {Berth::Least, Berth::ForTurns}) {
      const double turns =
          berth == Berth::ForTurns ? kOfTurnRadius * turn_radius_m(problem_.limits) : 0;
      keep_outs_[berth == Berth::ForTurns].emplace_back(
          zone, buffer_for(zone, problem_, kBuffer_m + turns));
    }
  }
}

const RiskMap& PlanningScene::risk() const {
  if (!risk_) {
    risk_.emplace(*terrain_, grid(), surface_.altitudes_m());
    if (problem_.exposure_weight > 0) risk_->add(problem_.radar_sites, problem_.exposure_weight);
    if (problem_.kill_weight_m > 0)
      risk_->add(problem_.missile_sites, problem_.kill_weight_m / problem_.limits.speed_m_s);
  }
  return *risk_;
}

const KeepOut* PlanningScene::zone_across(const GroundPoint& a, const GroundPoint& b,
                                          Berth berth) const {
  for (const KeepOut& zone : keep_outs(berth)) {
    if (!zone.crossed_on_map(a, b)) continue;
    // The final route flies no higher than the surface, but maybe lower: only passing below counts.
    const int pieces =
        std::max(1, static_cast<int>(std::ceil(distance_m(a, b) / grid().spacing_m())));
    for (int i = 0; i <= pieces; ++i) {
      const GroundPoint point = between(a, b, static_cast<double>(i) / pieces);
      if (surface_.altitude_m(point) >= zone.floor_m()) return &zone;
    }
  }
  return nullptr;
}

bool PlanningScene::free(const GroundPoint& a, const GroundPoint& b, Berth berth) const {
  const int pieces =
      std::max(1, static_cast<int>(std::ceil(2 * distance_m(a, b) / grid().spacing_m())));
  for (int i = 0; i <= pieces; ++i) {
    if (!surface_.open(between(a, b, static_cast<double>(i) / pieces), berth)) return false;
  }
  return !zone_across(a, b, berth);
}

bool PlanningScene::fears_threats() const {
  return (problem_.exposure_weight > 0 && !problem_.radar_sites.empty()) ||
         (problem_.kill_weight_m > 0 && !problem_.missile_sites.empty());
}

double PlanningScene::cost(const GroundPoint& a, const GroundPoint& b) const {
  const double length = distance_m(a, b);
  return fears_threats() ? length + risk().along(a, b) : length;
}

}  // namespace skein::navigation
