#include "decisions/contestant.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <thread>

#include "brokerless_discovery/broker.hpp"
#include "navigation/threats/keep_out.hpp"
#include "navigation/threats/radar_exposure.hpp"
#include "skein/error.hpp"
#include "skein/head.hpp"
#include "skein/introspection.idl.hpp"

namespace skein::benchmarks {
namespace {

using AE_navigator::IPlanner;
using AE_navigator::Position;
using AE_navigator::Problem;
using AE_navigator::Route;
using std::chrono::steady_clock;
using Flaw = std::optional<std::string>;

constexpr double kExposureTolerance = 0.01;

double distance_m(const Position& a, const Position& b) {
  return std::hypot(a.north_m - b.north_m, a.east_m - b.east_m, a.altitude_m - b.altitude_m);
}

Flaw judge_ends(const Problem& problem, const navigation::Terrain& terrain, const Route& route) {
  const auto outside = [&](const Position& p) { return !terrain.contains(p.north_m, p.east_m); };
  if (std::ranges::any_of(route.waypoints, outside)) return "it leaves the terrain";
  if (route.waypoints.size() < 2) return "it has fewer than two waypoints";
  if (distance_m(route.waypoints.front(), problem.start) > 0.01) return "it begins elsewhere";
  if (distance_m(route.waypoints.back(), problem.goal) > 0.01) return "it ends elsewhere";
  return std::nullopt;
}

Flaw judge_zones(const Problem& problem, const Route& route) {
  for (const auto& zone : problem.no_fly_zones) {
    const navigation::KeepOut keep_out(zone, 0);
    for (std::size_t i = 1; i < route.waypoints.size(); ++i) {
      if (keep_out.crossed_by(route.waypoints[i - 1], route.waypoints[i]))
        return "it enters a no-fly zone";
    }
  }
  return std::nullopt;
}

/// The Body's checks. That a planner which knows no cap exceeds it is no fault; to claim less than
/// there is would be one.
Evaluation<Route> checks_of(const Problem& problem, const navigation::Terrain& terrain) {
  Evaluation<Route> checks;
  checks.check("ends", [&](const Route& route) { return judge_ends(problem, terrain, route); });
  checks.check("zones", [&](const Route& route) { return judge_zones(problem, route); });
  checks.admitted("exposure cap", [&](const Route& route) -> Flaw {
    if (problem.exposure_cap_m == 0 || route.radar_exposure <= problem.exposure_cap_m)
      return std::nullopt;
    return "its exposure is beyond the cap";
  });
  checks.check("claimed exposure", [&](const Route& route) -> Flaw {
    const navigation::RadarExposure exposure(terrain, problem.radar_sites);
    if (exposure.along(route.waypoints) <= route.radar_exposure * (1 + kExposureTolerance) + 1)
      return std::nullopt;
    return "it is exposed more than it claims";
  });
  return checks;
}

Task<IPlanner, Route> task_of(const Problem& problem, const navigation::Terrain& terrain) {
  Task<IPlanner, Route> task;
  task.features = features_of(problem, terrain);
  task.run = [&problem](IPlanner::Proxy& csp, Duration) { return csp.async_plan(problem); };
  task.evaluate = checks_of(problem, terrain);
  // Here every right answer is as good as any other; only its time counts.
  task.quality = [](const Route&) { return 1.0; };
  return task;
}

void await_all(Entity& entity, std::size_t count) {
  const auto end = steady_clock::now() + std::chrono::seconds(10);
  while (entity.broker().find_service(entity.broker().query("AE_navigator/IPlanner")).size() <
         count) {
    if (steady_clock::now() > end) throw std::runtime_error("an algorithm was never seen");
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

HeadOptions head_options(const std::string& strategy) {
  HeadOptions options;
  options.strategy = strategy;
  options.max_stuck = SIZE_MAX;
  return options;
}

// One that is always chosen is never kept in quarantine.
HeadOptions head_of_one() {
  HeadOptions options = head_options("fixed_order");
  options.breaker.faults = UINT_MAX;
  return options;
}

}  // namespace

Contestant::Contestant(const std::string& strategy, const std::vector<Algorithm>& algorithms,
                       std::shared_ptr<navigation::TerrainProvider> terrains)
    : Contestant(strategy, head_options(strategy), algorithms, std::move(terrains)) {}

Contestant::Contestant(const Algorithm& algorithm,
                       std::shared_ptr<navigation::TerrainProvider> terrains)
    : Contestant(algorithm.name, head_of_one(), {algorithm}, std::move(terrains)) {}

Contestant::Contestant(std::string name, HeadOptions head, const std::vector<Algorithm>& algorithms,
                       std::shared_ptr<navigation::TerrainProvider> terrains)
    : name_(std::move(name)), terrains_(std::move(terrains)) {
  EntityOptions options;
  options.name = "navigator-" + name_;
  options.vendor = dds::load_vendor("loopback");
  options.head = std::move(head);
  entity_ = std::make_unique<Entity>(std::move(options));
  for (const Algorithm& algorithm : algorithms) {
    ServiceOptions service;
    service.attributes = algorithm.declared;
    entity_->provide_csp<IPlanner>(algorithm.name, entity_->id(), algorithm.planner, service);
  }
  await_all(*entity_, algorithms.size());
}

Answer Contestant::answer(const Request& request) {
  const auto terrain = terrains_->load(request.problem.terrain);
  Answer answer;
  introspection::Decision record;
  const auto begin = steady_clock::now();
  try {
    const auto task = task_of(request.problem, *terrain);
    const Duration limit = request.limit - (steady_clock::now() - begin);
    answer.route = entity_->head().perform(task, &record, limit);
    answer.outcome = "answered";
  } catch (const Error& error) {
    answer.outcome = to_string(error.code());
  } catch (const UserException&) {
    answer.outcome = "refused";
  }
  answer.time_ms = std::chrono::duration<double, std::milli>(steady_clock::now() - begin).count();
  answer.attempts = record.attempts.size();
  for (const introspection::Attempt& attempt : record.attempts) {
    answer.chosen = attempt.csp;
    if (attempt.outcome == introspection::Outcome::Accepted) break;
  }
  return answer;
}

void Contestant::settle() const {
  const auto at_work = [](const auto& service) { return service.running > 0; };
  while (std::ranges::any_of(entity_->statistics(), at_work)) std::this_thread::yield();
}

Features features_of(const Problem& problem, const navigation::Terrain& terrain) {
  double tightness = 0;  // of no cap
  if (problem.exposure_cap_m > 0) {
    const navigation::RadarExposure exposure(terrain, problem.radar_sites);
    tightness = exposure.along(problem.start, problem.goal) / (problem.exposure_cap_m + 1);
  }
  return {{"points", static_cast<double>(terrain.rows()) * terrain.columns()},
          {"zones", static_cast<double>(problem.no_fly_zones.size())},
          {"distance", distance_m(problem.start, problem.goal)},
          {"radars", static_cast<double>(problem.radar_sites.size())},
          {"tightness", tightness}};
}

}  // namespace skein::benchmarks
