#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "navigation/terrain/terrain_provider.hpp"
#include "navigator.idl.hpp"
#include "skein/clock.hpp"

namespace skein::navigation {

/// Whether the call that this thread works for was cancelled or its deadline has passed; false
/// outside of any call.
bool current_call_cancelled();

struct PlannerOptions {
  /// Polled every few hundred steps at least; true ends the planning, with NoRoute where there is
  /// no route yet.
  std::function<bool()> stop = current_call_cancelled;
  /// Against this the Problem's time limit is measured.
  std::function<Instant()> now = std::chrono::steady_clock::now;
  /// Of the samplers: the same seed gives the same samples.
  std::uint32_t seed = 1;
  /// The most time for a route, even if the Problem allows more; 0: only the Problem counts.
  std::uint32_t time_limit_ms = 0;
  /// Distance between the points of the planning grid; 0 takes 1/256 of the terrain's longer side,
  /// but never less than the distance between its posts.
  double grid_spacing_m = 0;
  /// The most exposure that CappedAStar's routes may have, in metres, whatever the Problem allows.
  double exposure_cap_m = std::numeric_limits<double>::infinity();
};

// What every planner here promises. `plan` returns a route that satisfies the Problem in every
// respect that `navigator.idl` names: it ends at the goal, keeps clear of zones and ground between
// waypoints too, and climbs and turns no tighter than the limits. Otherwise it throws
// InvalidProblem (no planner could answer) or NoRoute, with the reason: unreachable, out of time,
// stopped. It never returns a route that is only nearly right. Routes stay near the lowest altitude
// that ground, climb limit, start and goal allow. One planner may serve several threads at once.

/// The planners that may share a process with others (of OMPL 1.5.2, BITstar and AITstar may not:
/// they do not return in their time, and BITstar crashes), by the names that make_planner knows and
/// that the routes carry:
/// - AStar: cheapest path by A* on a grid, what threats cost included, drawn taut. The slowest to a
///   first answer, near the optimum, and the only one that proves that there is none: an
///   unreachable goal is refused with the zones or mountains that enclose it.
/// - CappedAStar: the shortest route whose exposure is no more than `exposure_cap_m`, the Problem's
///   and the option's, whatever the Problem's weight, as far as A* with some weight finds it
///   (Lagrangian relaxation): shorter ones between two weights are missed. Without a cap or without
///   radars it is the shortest route. Several times as slow as A*; brings each shorter route that
///   it finds. Refuses, without a proof, if no route keeps the cap.
/// - RRTConnect: two trees grown towards each other: an answer within milliseconds, often long and
///   careless of radars. Searches on until its time is up if there is no route.
/// - RRTstar: a tree that is improved for as long as there is time: the more time, the cheaper the
///   route. When its time is up the best route so far is the answer; so it is with InformedRRTstar.
/// - InformedRRTstar: as RRTstar, but as soon as there is a route it samples only places that a
///   cheaper one may lead through.
/// - PRMstar: a map of roads that grows denser for as long as there is time. Brings only its last
///   route.
const std::vector<std::string>& planner_names();

/// Makes one by its name, or LegacyDubins, which planner_names() leaves out: a tree of the Dubins
/// paths of OMPL 1.5.2, an old library behind the interface of today, and a real danger. Sooner or
/// later an assertion in it aborts the process, so it is for processes of their own alone: its
/// component says `isolated`, and a profile that has it work in its entity's process is refused.
/// Throws InvalidArgument for an unknown name, with the nearest known, and for a cap below 0.
std::unique_ptr<AE_navigator::IPlanner> make_planner(const std::string& name,
                                                     std::shared_ptr<TerrainProvider> terrains,
                                                     PlannerOptions options = {});

}  // namespace skein::navigation
