#include "decisions/algorithms.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "decisions/worlds.hpp"
#include "navigation/grid/grid_planner.hpp"
#include "navigation/planners/planners.hpp"
#include "navigation/threats/radar_exposure.hpp"
#include "skein/call_context.hpp"

namespace skein::benchmarks {
namespace {

using AE_navigator::IPlanner;
using AE_navigator::NoRoute;
using AE_navigator::Problem;
using AE_navigator::Route;
using navigation::TerrainProvider;
using navigation::grid::Cell;
using navigation::grid::GridMap;
using std::chrono::steady_clock;

/// The cells that a zone's box touches are blocked: zones here are boxes of whole cells.
std::shared_ptr<const GridMap> cells_of(const Problem& problem,
                                        const navigation::Terrain& terrain) {
  auto map = std::make_shared<GridMap>(terrain.columns() - 1, terrain.rows() - 1);
  for (const auto& zone : problem.no_fly_zones) {
    const auto [south, north] =
        std::ranges::minmax(zone.outline, {}, [](const auto& corner) { return corner.north_m; });
    const auto [west, east] =
        std::ranges::minmax(zone.outline, {}, [](const auto& corner) { return corner.east_m; });
    const auto cell = [](double metres) { return static_cast<int>(std::lround(metres / kCellM)); };
    for (int y = cell(south.north_m); y < cell(north.north_m); ++y) {
      for (int x = cell(west.east_m); x < cell(east.east_m); ++x) map->block({x, y});
    }
  }
  return map;
}

Cell cell_at(const AE_navigator::Position& position) {
  return {static_cast<int>(position.east_m / kCellM), static_cast<int>(position.north_m / kCellM)};
}

Route route_along(std::vector<AE_navigator::Position> waypoints, const Problem& problem,
                  const navigation::Terrain& terrain) {
  Route route;
  route.waypoints = std::move(waypoints);
  for (std::size_t i = 1; i < route.waypoints.size(); ++i) {
    const auto &from = route.waypoints[i - 1], &to = route.waypoints[i];
    route.length_m += std::hypot(to.north_m - from.north_m, to.east_m - from.east_m);
  }
  route.lowest_height_above_ground_m = problem.start.altitude_m - terrain.highest_m();
  route.radar_exposure =
      navigation::RadarExposure(terrain, problem.radar_sites).along(route.waypoints);
  return route;
}

/// A planner on grids, over flat land.
class GridPlanner final : public IPlanner {
 public:
  GridPlanner(std::string planner, std::shared_ptr<TerrainProvider> terrains)
      : planner_(std::move(planner)), terrains_(std::move(terrains)) {}

  Route plan(const Problem& problem) override {
    const auto terrain = terrains_->load(problem.terrain);
    const auto planner = navigation::grid::make_grid_planner(planner_, cells_of(problem, *terrain));
    const auto path = planner->plan(cell_at(problem.start), cell_at(problem.goal));
    if (!path) throw NoRoute("there is no way from cell to cell", false);
    std::vector<AE_navigator::Position> waypoints;
    for (const Cell& cell : path->corners) waypoints.push_back(middle_of(cell));
    return route_along(std::move(waypoints), problem, *terrain);
  }

 private:
  const std::string planner_;
  const std::shared_ptr<TerrainProvider> terrains_;
};

class Direct final : public IPlanner {
 public:
  explicit Direct(std::shared_ptr<TerrainProvider> terrains) : terrains_(std::move(terrains)) {}

  Route plan(const Problem& problem) override {
    return route_along({problem.start, problem.goal}, problem, *terrains_->load(problem.terrain));
  }

 private:
  const std::shared_ptr<TerrainProvider> terrains_;
};

class Boaster final : public IPlanner {
 public:
  explicit Boaster(std::unique_ptr<IPlanner> planner) : planner_(std::move(planner)) {}

  Route plan(const Problem& problem) override {
    Route route = planner_->plan(problem);
    route.radar_exposure = 0;
    return route;
  }

 private:
  const std::unique_ptr<IPlanner> planner_;
};

/// An algorithm on a bad day: takes a multiple of its time, or for ever.
class Staged final : public IPlanner {
 public:
  Staged(std::string name, std::unique_ptr<IPlanner> planner, Stage& stage)
      : name_(std::move(name)), planner_(std::move(planner)), stage_(stage) {}

  Route plan(const Problem& problem) override {
    stage_.enter();
    const std::shared_ptr<void> leave(nullptr, [this](void*) { stage_.leave(); });
    if (stage_.hang(name_)) throw NoRoute("it hung", false);
    const double factor = stage_.factor(name_);
    Problem timed = problem;
    timed.time_limit_ms = time_limit_ms(factor);
    const auto begin = steady_clock::now();
    try {
      Route route = planner_->plan(timed);
      spin(begin, factor);
      return route;
    } catch (const NoRoute&) {
      spin(begin, factor);
      throw;
    }
  }

 private:
  /// What is left, so that the planner ends in time however slow it is today.
  static std::uint32_t time_limit_ms(double factor) {
    const Duration left = CallContext::current()->remaining();
    return 1 + static_cast<std::uint32_t>(std::chrono::duration<double, std::milli>(left).count() /
                                          factor);
  }

  static void spin(steady_clock::time_point begin, double factor) {
    const auto end =
        begin + std::chrono::duration_cast<Duration>((steady_clock::now() - begin) * factor);
    while (steady_clock::now() < end && !CallContext::current()->cancelled()) {
    }
  }

  const std::string name_;
  const std::unique_ptr<IPlanner> planner_;
  Stage& stage_;
};

struct Make {
  const char* name;
  const char* planner;  // null: none of src/navigation
  double spacing_m;     // 0: on cells
  const char* latency_ms;
  const char* quality;
};

// Declared is what their maker may have measured on 64 x 64 cells.
constexpr Make kMakes[] = {{"Boaster", "AStar", 100, "0.5", "1"},
                           {"Capped", "CappedAStar", 100, "150", "1"},
                           {"CappedCoarse", "CappedAStar", 300, "20", "0.7"},
                           {"Direct", nullptr, 0, "0.1", "0.9"},
                           {"Jumper", "jps", 0, "1", "0.3"},
                           {"LazyTheta", "theta", 0, "2", "0.4"},
                           {"Sampler", "RRTConnect", 100, "10", "0.5"},
                           {"Weighted", "AStar", 100, "30", "0.8"}};

std::unique_ptr<IPlanner> make_one(const Make& make, std::shared_ptr<TerrainProvider> terrains) {
  const std::string name = make.name;
  if (name == "Direct") return std::make_unique<Direct>(std::move(terrains));
  if (make.spacing_m == 0) return std::make_unique<GridPlanner>(make.planner, std::move(terrains));
  navigation::PlannerOptions options;
  options.grid_spacing_m = make.spacing_m;
  auto planner = navigation::make_planner(make.planner, std::move(terrains), options);
  if (name == "Boaster") return std::make_unique<Boaster>(std::move(planner));
  return planner;
}

}  // namespace

void Stage::set(std::map<std::string, double> factors, std::string hangs) {
  const std::lock_guard lock(mutex_);
  factors_ = std::move(factors);
  hangs_ = std::move(hangs);
}

void Stage::clear() {
  std::unique_lock lock(mutex_);
  hangs_.clear();
  changed_.notify_all();
  changed_.wait(lock, [&] { return at_work_ == 0; });
}

double Stage::factor(const std::string& algorithm) const {
  const std::lock_guard lock(mutex_);
  const auto found = factors_.find(algorithm);
  return found == factors_.end() ? 1 : found->second;
}

bool Stage::hang(const std::string& algorithm) {
  std::unique_lock lock(mutex_);
  const auto hangs = [&] { return hangs_ == "all" || hangs_ == algorithm; };
  if (!hangs()) return false;
  changed_.wait(lock, [&] { return !hangs(); });
  return true;
}

void Stage::enter() {
  const std::lock_guard lock(mutex_);
  ++at_work_;
}

void Stage::leave() {
  const std::lock_guard lock(mutex_);
  --at_work_;
  changed_.notify_all();
}

std::vector<Algorithm> make_algorithms(const std::shared_ptr<TerrainProvider>& terrains,
                                       Stage& stage) {
  std::vector<Algorithm> algorithms;
  for (const Make& make : kMakes) {
    algorithms.push_back({make.name,
                          {{"latency", make.latency_ms}, {"quality", make.quality}},
                          std::make_shared<Staged>(make.name, make_one(make, terrains), stage)});
  }
  return algorithms;
}

const std::vector<std::string>& algorithm_names() {
  static const std::vector<std::string> kNames = [] {
    std::vector<std::string> names;
    for (const Make& make : kMakes) names.emplace_back(make.name);
    return names;
  }();
  return kNames;
}

}  // namespace skein::benchmarks
