#include "decisions/requests.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "navigation/grid/grid_planner.hpp"
#include "navigation/threats/radar_exposure.hpp"
#include "skein/error.hpp"

namespace skein::benchmarks {
namespace {

using AE_navigator::Position;
using navigation::grid::Cell;
using navigation::grid::GridPath;

using Fields = std::vector<std::string>;

/// From one share of a part to another the factor goes to `factor`, and stays.
struct Drift {
  double from;
  double to;
  std::string algorithm;
  double factor;
};

/// The factor of each request is drawn from a Pareto distribution.
struct HeavyTail {
  std::string algorithm;
  double shape;
};

/// Where there are so many radar sites, the algorithm hangs.
struct Trap {
  std::string algorithm;
  std::size_t radars;
};

/// What befalls the algorithms in a part.
struct Conditions {
  std::uint32_t seed = 0;  // of the order
  std::vector<Drift> drifts{};
  std::vector<HeavyTail> tails{};
  std::vector<Trap> traps{};
};

double log_uniform(double low, double high, std::mt19937& random) {
  return low * std::pow(high / low, share(random));
}

/// Draws the requests of one world.
class Drawing {
 public:
  Drawing(std::shared_ptr<const World> world, std::uint32_t seed,
          const std::vector<std::string>& algorithms)
      : world_(std::move(world)),
        algorithms_(algorithms),
        random_(seed),
        planner_(navigation::grid::make_grid_planner("jps", world_->map)) {}

  Request draw() {
    Request request;
    request.world = world_;
    AE_navigator::Problem& problem = request.problem;
    problem.terrain = world_->terrain->name();
    problem.no_fly_zones = world_->zones;
    problem.minimum_height_above_ground_m = 50;
    problem.limits = {30, 10, 0, 1000};
    problem.exposure_weight = 0.3;
    const GridPath way = draw_way();
    problem.start = middle_of(way.corners.front());
    problem.goal = middle_of(way.corners.back());
    if (share(random_) < 0.6) add_radars(request.problem, way);
    request.limit =
        std::chrono::microseconds(static_cast<std::int64_t>(1000 * log_uniform(1, 2000, random_)));
    if (share(random_) < 0.08) add_hang(request);
    return request;
  }

 private:
  GridPath draw_way() {
    const int width = world_->map->width(), height = world_->map->height();
    while (true) {
      Cell start, goal;
      start.x = below(width, random_);
      start.y = below(height, random_);
      goal.x = below(width, random_);
      goal.y = below(height, random_);
      if (3 * std::hypot(start.x - goal.x, start.y - goal.y) < std::max(width, height)) continue;
      if (auto way = planner_->plan(start, goal)) return *way;
    }
  }

  void add_radars(AE_navigator::Problem& problem, const GridPath& way) {
    const double side_m = kCellM * std::max(world_->map->width(), world_->map->height());
    const int count = 1 + below(3, random_);
    for (int i = 0; i < count; ++i) {
      const auto corner =
          static_cast<std::size_t>(below(static_cast<int>(way.corners.size()) - 1, random_));
      const Position a = middle_of(way.corners[corner]), b = middle_of(way.corners[corner + 1]);
      const double along = share(random_);
      const auto coordinate = [&](double from, double to) {
        const double aside = (share(random_) - 0.5) * 0.2 * side_m;
        return std::clamp(from + along * (to - from) + aside, 0.0, side_m);
      };
      AE_navigator::RadarSite radar{"radar", {}, 20, 0, 1};
      radar.site.north_m = coordinate(a.north_m, b.north_m);
      radar.site.east_m = coordinate(a.east_m, b.east_m);
      radar.range_m = side_m * (0.05 + 0.1 * share(random_));
      problem.radar_sites.push_back(radar);
    }
    if (share(random_) * 3 > 2) return;
    const double share_of_exposure = log_uniform(0.4, 1.4, random_);
    std::vector<Position> waypoints;
    for (const Cell& cell : way.corners) waypoints.push_back(middle_of(cell));
    const navigation::RadarExposure exposure(*world_->terrain, problem.radar_sites);
    problem.exposure_cap_m = share_of_exposure * exposure.along(waypoints);
  }

  void add_hang(Request& request) {
    const bool all = below(2, random_) == 0;
    const auto one = static_cast<std::size_t>(below(static_cast<int>(algorithms_.size()), random_));
    request.hangs = all ? kAllHang : algorithms_[one];
    request.limit =
        std::chrono::microseconds(static_cast<std::int64_t>(1000 * log_uniform(1, 30, random_)));
  }

  const std::shared_ptr<const World> world_;
  const std::vector<std::string>& algorithms_;
  std::mt19937 random_;
  const std::unique_ptr<navigation::grid::GridPlanner> planner_;
};

class Reading {
 public:
  Reading(const std::filesystem::path& file, const std::vector<std::string>& algorithms)
      : file_(file), algorithms_(algorithms) {
    requests_.terrains = std::make_shared<navigation::TerrainProvider>();
  }

  Requests read(std::size_t every) {
    std::ifstream stream(file_);
    std::string line;
    for (int number = 1; std::getline(stream, line); ++number) {
      if (line.empty() || line.front() == '#') continue;
      try {
        take(fields_of(line));
      } catch (const std::exception& error) {
        throw InvalidArgument(file_.string() + ":" + std::to_string(number) + ": " + error.what());
      }
    }
    if (!stream.eof()) throw InvalidArgument(file_.string() + " cannot be read");
    for (const char* part : {"training", "held_out"}) put_in_order(part, every);
    return std::move(requests_);
  }

 private:
  static Fields fields_of(const std::string& line) {
    Fields fields;
    std::istringstream stream(line);
    for (std::string field; std::getline(stream, field, ',');) fields.push_back(field);
    return fields;
  }

  void take(const Fields& fields) {
    const std::string& what = fields.at(0);
    Conditions& conditions = conditions_[fields.at(1)];
    if (what == "order") {
      conditions.seed = number(fields.at(2));
    } else if (what == "world") {
      take_world(fields);
    } else if (what == "drift") {
      conditions.drifts.push_back({std::stod(fields.at(2)), std::stod(fields.at(3)),
                                   known(fields.at(4)), std::stod(fields.at(5))});
    } else if (what == "tail") {
      conditions.tails.push_back({known(fields.at(2)), std::stod(fields.at(3))});
    } else if (what == "trap") {
      conditions.traps.push_back({known(fields.at(2)), number(fields.at(3))});
    } else {
      throw InvalidArgument("'" + what + "' is none of order, world, drift, tail and trap");
    }
  }

  const std::string& known(const std::string& algorithm) const {
    if (std::ranges::find(algorithms_, algorithm) == algorithms_.end())
      throw InvalidArgument("there is no algorithm '" + algorithm + "'");
    return algorithm;
  }

  static std::uint32_t number(const std::string& text) {
    return static_cast<std::uint32_t>(std::stoul(text));
  }

  void take_world(const Fields& fields) {
    const std::uint32_t seed = number(fields.at(4));
    const std::uint32_t count = number(fields.at(5));
    const auto world = world_of(fields, seed);
    if (!world) {
      requests_.without_data += count;
      return;
    }
    requests_.terrains->add(world->terrain);
    Drawing drawing(world, seed, algorithms_);
    for (std::uint32_t i = 0; i < count; ++i) parts_[fields.at(1)].push_back(drawing.draw());
  }

  static std::shared_ptr<const World> world_of(const Fields& fields, std::uint32_t seed) {
    if (fields.at(2) != "recorded") {
      return std::make_shared<const World>(
          make_world(fields.at(2), static_cast<int>(number(fields.at(3))), seed));
    }
    const char* data = std::getenv("SKEIN_TEST_DATA");
    const auto map = std::filesystem::path(data ? data : "") / "movingai" / fields.at(3);
    if (!data || !std::filesystem::exists(map)) return nullptr;
    return std::make_shared<const World>(read_world(map));
  }

  void put_in_order(const std::string& part, std::size_t every) {
    std::vector<Request>& drawn = parts_[part];
    const Conditions& conditions = conditions_[part];
    std::mt19937 random(conditions.seed);
    for (std::size_t i = drawn.size(); i > 1; --i) {
      std::swap(drawn[i - 1], drawn[static_cast<std::size_t>(below(static_cast<int>(i), random))]);
    }
    for (std::size_t i = 0; i < drawn.size(); ++i) {
      drawn[i].part = part;
      drawn[i].number = i;
      set_conditions(drawn[i], conditions,
                     static_cast<double>(i) / static_cast<double>(drawn.size()), random);
      if (i % every == 0) requests_.all.push_back(std::move(drawn[i]));
    }
  }

  static void set_conditions(Request& request, const Conditions& conditions, double passed,
                             std::mt19937& random) {
    for (const Drift& drift : conditions.drifts) {
      if (passed < drift.from) continue;
      const auto [now, first] = request.factors.try_emplace(drift.algorithm, 1);
      const double way = passed >= drift.to ? 1 : (passed - drift.from) / (drift.to - drift.from);
      now->second *= std::pow(drift.factor / now->second, way);
    }
    for (const HeavyTail& tail : conditions.tails) {
      const auto [factor, first] = request.factors.try_emplace(tail.algorithm, 1);
      factor->second *= std::pow(1 - share(random), -1 / tail.shape);
    }
    for (const Trap& trap : conditions.traps) {
      if (request.hangs.empty() && request.problem.radar_sites.size() >= trap.radars)
        request.hangs = trap.algorithm;
    }
  }

  const std::filesystem::path file_;
  const std::vector<std::string>& algorithms_;
  Requests requests_;
  std::map<std::string, std::vector<Request>> parts_;
  std::map<std::string, Conditions> conditions_;
};

}  // namespace

Requests read_requests(const std::filesystem::path& instances,
                       const std::vector<std::string>& algorithms, std::size_t every) {
  return Reading(instances, algorithms).read(every);
}

}  // namespace skein::benchmarks
