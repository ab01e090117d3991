#include "mission_navigator.hpp"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <utility>

#include "convert.hpp"
#include "deciding.hpp"
#include "flight/angles.hpp"
#include "planning/threat_discs.hpp"
#include "planning/turns.hpp"
#include "skein/error.hpp"
#include "skein/introspection.idl.hpp"
#include "topics.hpp"

namespace reconnaissance {
namespace {

// Above the ground, as planners are asked for it; and what a way must keep, whoever made it.
constexpr double kLeastHeight_m = 250;
constexpr double kLeastClearance_m = 200;
// Of a way home, if none keeps that.
constexpr double kLeastAnyway_m = 60;
// The aircraft gains height from an end of a way on which it is lower than that.
constexpr double kGain = 0.08;
constexpr double kHighest_m = 4000;
constexpr double kShareOfClimb = 0.9;
// Of a site that stands where it is thought to be.
constexpr double kMast_m = 10;
// Turns are flown less tightly than they are drawn: so near to what a weapon reaches, planners
// reckon with a few thousandths of its kills, and keep further away where that is no long detour.
constexpr double kBeside_m = 400;
constexpr double kShareBeside = 3e-3;
// Metres of detour that an expected kill is worth: more than any way around.
constexpr double kKillWeight_m = 1e6;
// Between the course that is flown and that of a way, from which on one turns back.
constexpr double kTurnsBack_rad = 1.5;
// Expected kills, by which turns that are flown may be worse than the way that a planner found.
constexpr double kTurnHazard = 2e-4;

AE_navigator::Position in_tile(const Tile& tile, const recon::Position& place) {
  const Local at = tile.to_tile(geodetic(place));
  return {at.north_m, at.east_m, at.height_m};
}

/// Why a route does not lead from end to end of a problem; nothing if it does.
std::optional<std::string> misses_an_end(const AE_navigator::Problem& problem,
                                         const AE_navigator::Route& route) {
  if (route.waypoints.size() >= 2 && route.waypoints.front() == problem.start &&
      route.waypoints.back() == problem.goal)
    return std::nullopt;
  return "it does not lead from the start to the goal";
}

std::optional<std::string> climbs_too_steeply(const AE_navigator::Problem& problem,
                                              const AE_navigator::Route& route) {
  for (std::size_t i = 1; i < route.waypoints.size(); ++i) {
    const auto &from = route.waypoints[i - 1], &to = route.waypoints[i];
    const double level = map_distance_m(to, from);
    const double climb_deg = degrees(std::atan2(to.altitude_m - from.altitude_m, level));
    if (!(std::abs(climb_deg) <= problem.limits.maximum_climb_angle_deg + 0.1))
      return fmt::format("leg {} climbs {:.1f} degrees, more than the aircraft can", i, climb_deg);
  }
  return std::nullopt;
}

/// By the discs on the map, not by what the planner says of its route; both in the tile.
double hazard_of(const AE_navigator::Problem& problem, const std::vector<Local>& way) {
  std::vector<ThreatDisc> discs;
  for (const AE_navigator::MissileSite& site : problem.missile_sites)
    discs.push_back({site.site.north_m, site.site.east_m, site.range_m, site.kills_per_second});
  return hazard_of_way(way, discs, problem.limits.speed_m_s);
}

Local place(const AE_navigator::Position& in_tile) {
  return {in_tile.north_m, in_tile.east_m, in_tile.altitude_m};
}

/// Whether who started this process has started that one, too; on another host nobody has.
bool is_sibling(pid_t process) {
  std::ifstream stream(fmt::format("/proc/{}/stat", process));
  std::string text;
  std::getline(stream, text);
  // Behind the name, which may hold anything, stand its state and its parent.
  std::istringstream words(text.substr(std::min(text.size(), text.rfind(')') + 1)));
  std::string state;
  pid_t parent = 0;
  return words >> state >> parent && parent == getppid();
}

std::string accepted(const skein::introspection::Decision& decision) {
  for (const auto& attempt : decision.attempts)
    if (attempt.outcome == skein::introspection::Outcome::Accepted) return attempt.csp;
  return "";
}

}  // namespace

Navigator::Navigator(skein::Entity& entity, const skein::ParameterValues& values)
    : entity_(entity),
      frame_(parse_runway(values.get<std::string>("Runway")).threshold),
      ground_(ground_of(values)),
      tile_(parse_runway(values.get<std::string>("Runway")).threshold),
      failures_(parse_planner_failures(values.find<std::string>("Planner failures").value_or(""))),
      threats_(entity, topic::kThreats, skein::TopicQos::state()),
      member_(entity, values) {
  // Planners read terrain from files: beside the mission's results, and for this process alone.
  const auto folder = std::filesystem::absolute(fmt::format("ground-{}", getpid()));
  std::filesystem::create_directories(folder);
  terrain_ = folder / tile_.file_name();
  tile_.write(terrain_, frame_, ground_);
}

Navigator::~Navigator() {
  std::error_code ignored;
  std::filesystem::remove_all(std::filesystem::path(terrain_).parent_path(), ignored);
}

recon::Route Navigator::plan(const recon::RouteRequest& request) {
  if (request.through.empty()) throw recon::NoRoute("there is no point to fly over");
  least_clearance_m_ = kLeastClearance_m;
  try {
    return make_route(request);
  } catch (const recon::NoRoute&) {
    // An aircraft that flies home needs a way.
    if (request.least_survival > 0) throw;
    least_clearance_m_ = kLeastAnyway_m;
    return make_route(request);
  }
}

recon::Route Navigator::make_route(const recon::RouteRequest& request) {
  instead_.clear();
  AE_navigator::Problem problem = problem_of(request);
  recon::Route route;
  route.points = {request.from};
  double course = request.course_rad;
  for (std::size_t i = 0; i < request.through.size(); ++i) {
    recon::WayPoint next = request.through[i];
    if (i + 1 < request.through.size()) lift(next.position);
    if (!next.straight) {
      pose(problem, route.points.back(), next.position);
      const AE_navigator::Route found = ask_planner(problem, request.least_survival);
      std::vector<Local> way{local(frame_, route.points.back())};
      for (std::size_t j = 1; j + 1 < found.waypoints.size(); ++j)
        way.push_back(frame_.to_local(tile_.to_geodetic(place(found.waypoints[j]))));
      way.push_back(local(frame_, next.position));
      if (i + 1 < request.through.size() && request.through[i + 1].straight) {
        const Local onto = local(frame_, request.through[i + 1].position);
        way = onto_course(problem, way, course, course_between_rad(way.back(), onto),
                          request.limits.turn_radius_m);
      }
      for (std::size_t j = 1; j + 1 < way.size(); ++j)
        route.points.push_back(position(frame_, way[j]));
      route.planner = found.planner;
    }
    route.points.push_back(next.position);
    const auto last = route.points.end();
    course = course_between_rad(local(frame_, last[-2]), local(frame_, last[-1]));
  }
  const auto points = locals(frame_, route.points);
  const double survival = std::exp(-hazard_of(problem, way_in_tile(points)));
  if (survival < request.least_survival)
    throw recon::NoRoute(fmt::format("the whole way survives with {:.3f}", survival));
  for (std::size_t i = 1; i < points.size(); ++i)
    route.length_m += map_distance_m(points[i], points[i - 1]);
  route.number = ++routes_;
  return route;
}

/// Where less than the least height is over the ground: of any point but the last, which may be a
/// runway.
void Navigator::lift(recon::Position& point) const {
  const Local at = local(frame_, point);
  point.height_m = std::max(point.height_m, ground_(at.north_m, at.east_m) + kLeastHeight_m);
}

/// With its turns, the shortest ones, or others where those lead into what the planner's way leads
/// around, or over. Where all do, without; but who has to turn back anyway does so where it costs
/// least.
std::vector<Local> Navigator::onto_course(const AE_navigator::Problem& problem,
                                          const std::vector<Local>& way, double begin_course_rad,
                                          double end_course_rad, double radius_m) const {
  const double least = hazard_of(problem, way_in_tile(way));
  const bool turns_back =
      std::abs(wrapped(course_between_rad(way[0], way[1]) - begin_course_rad)) > kTurnsBack_rad;
  std::vector<Local> best = way;
  double hazard = turns_back ? std::numeric_limits<double>::infinity() : least + kTurnHazard;
  for (const int quarters : {0, -1, 1, -2, 2}) {
    std::vector<Local> turned =
        with_turns(way, begin_course_rad, end_course_rad, radius_m, quarters);
    for (std::size_t i = 1; i + 1 < turned.size(); ++i)
      turned[i].height_m = std::max(turned[i].height_m,
                                    ground_(turned[i].north_m, turned[i].east_m) + kLeastHeight_m);
    if (lack_of_height(turned)) continue;
    const double own = hazard_of(problem, way_in_tile(turned));
    if (own <= least + kTurnHazard) return turned;
    if (own >= hazard) continue;
    hazard = own;
    best = std::move(turned);
  }
  return best;
}

std::vector<Local> Navigator::way_in_tile(const std::vector<Local>& way) const {
  std::vector<Local> result;
  for (const Local& each : way) result.push_back(tile_.to_tile(frame_.to_geodetic(each)));
  return result;
}

/// Where a way is too low above the ground, in words; nothing if it is not.
std::optional<std::string> Navigator::lack_of_height(const std::vector<Local>& way) const {
  constexpr double kStep_m = 100;
  std::vector<Local> places{way.front()};
  for (std::size_t i = 1; i < way.size(); ++i) {
    const Local &from = way[i - 1], &to = way[i];
    const int steps = std::max(1, static_cast<int>(std::ceil(map_distance_m(to, from) / kStep_m)));
    for (int step = 1; step <= steps; ++step) {
      const double share = static_cast<double>(step) / steps;
      places.push_back({std::lerp(from.north_m, to.north_m, share),
                        std::lerp(from.east_m, to.east_m, share),
                        std::lerp(from.height_m, to.height_m, share)});
    }
  }
  const auto above_m = [&](const Local& place) {
    return place.height_m - ground_(place.north_m, place.east_m);
  };
  const auto climbed_m = [&](const Local& end, const Local& place) {
    return above_m(end) + kGain * map_distance_m(end, place) - 1;
  };
  for (const Local& each : places) {
    const double needed_m =
        std::min({least_clearance_m_, climbed_m(way.front(), each), climbed_m(way.back(), each)});
    if (above_m(each) < needed_m)
      return fmt::format("it is {:.0f} m above the ground at a place where {:.0f} are needed",
                         above_m(each), needed_m);
  }
  return std::nullopt;
}

/// From end to end: as high as it wants to be there, or as the aircraft can be. It goes on climbing
/// then.
void Navigator::pose(AE_navigator::Problem& problem, const recon::Position& from,
                     const recon::Position& to) const {
  problem.start = in_tile(tile_, from);
  problem.goal = in_tile(tile_, to);
  const Local at = local(frame_, from);
  problem.start.altitude_m =
      std::max(problem.start.altitude_m, ground_(at.north_m, at.east_m) + kLeastHeight_m + 1);
  const double level_m = map_distance_m(problem.goal, problem.start);
  const double most_m =
      kShareOfClimb * level_m * std::tan(radians(problem.limits.maximum_climb_angle_deg));
  problem.goal.altitude_m = std::clamp(problem.goal.altitude_m, problem.start.altitude_m - most_m,
                                       problem.start.altitude_m + most_m);
}

/// Without its ends.
AE_navigator::Problem Navigator::problem_of(const recon::RouteRequest& request) {
  AE_navigator::Problem problem;
  problem.terrain = terrain_;
  problem.minimum_height_above_ground_m = kLeastHeight_m;
  problem.limits = {request.limits.speed_m_s, degrees(request.limits.greatest_climb_rad) * 0.9,
                    degrees(request.limits.greatest_bank_rad), kHighest_m};
  problem.kill_weight_m = kKillWeight_m;
  const auto picture = threats_.at(request.tick);
  if (!picture) return problem;
  for (const recon::Threat& threat : picture->threats) {
    if (threat.lethal_range_m == 0) continue;
    // Planners know no site beyond their tile: in the tile, this disc covers what that one does.
    const Local there = tile_.to_tile(geodetic(threat.position)), site = tile_.nearest(there);
    const double beyond_m = map_distance_m(there, site);
    const auto add = [&](double range_m, double kills_per_s) {
      if (range_m <= beyond_m) return;
      problem.missile_sites.push_back({fmt::format("{} {}", threat.kind, threat.number),
                                       {site.north_m, site.east_m},
                                       kMast_m,
                                       std::sqrt(range_m * range_m - beyond_m * beyond_m),
                                       kills_per_s});
    };
    const double range_m = reach_m(threat.lethal_range_m, threat.deviation_m);
    add(range_m, kKills_per_s);
    add(range_m + kBeside_m, kKills_per_s * kShareBeside);
  }
  return problem;
}

/// The process of who works for the Head now.
void Navigator::signal_planner(int signal) const {
  for (const skein::Head::Current& each : entity_.head().running()) {
    const auto process = static_cast<pid_t>(each.pid);
    if (process != getpid() && is_sibling(process)) ::kill(process, signal);
  }
}

AE_navigator::Route Navigator::ask_planner(const AE_navigator::Problem& problem,
                                           double least_survival) {
  skein::Task<AE_navigator::IPlanner, AE_navigator::Route> task;
  task.request = fmt::format("route {}", routes_ + 1);
  task.only = instead_;
  const auto failure = std::ranges::find(failures_, ++asked_, &PlannerFailureText::request);
  bool fails_now = failure != failures_.end();
  task.features = {{"threats", static_cast<double>(problem.missile_sites.size())},
                   {"length_m", map_distance_m(problem.goal, problem.start)}};
  task.run = [&](AE_navigator::IPlanner::Proxy& planner, skein::Duration) {
    if (std::exchange(fails_now, false)) signal_planner(failure->stopped ? SIGSTOP : SIGKILL);
    return planner.plan(problem);
  };
  task.evaluate.check("leads from end to end", [&](const AE_navigator::Route& route) {
    return misses_an_end(problem, route);
  });
  task.evaluate.check("can be climbed", [&](const AE_navigator::Route& route) {
    return climbs_too_steeply(problem, route);
  });
  task.evaluate.check("keeps above the ground", [&](const AE_navigator::Route& route) {
    std::vector<Local> way;
    for (const AE_navigator::Position& each : route.waypoints)
      way.push_back(frame_.to_local(tile_.to_geodetic(place(each))));
    return lack_of_height(way);
  });
  // That no way leads around is no planner's fault.
  task.evaluate.admitted("survives",
                         [&](const AE_navigator::Route& route) -> std::optional<std::string> {
                           std::vector<Local> way;
                           for (const AE_navigator::Position& each : route.waypoints)
                             way.push_back(place(each));
                           const double survival = std::exp(-hazard_of(problem, way));
                           if (survival >= least_survival) return std::nullopt;
                           return fmt::format("it survives with {:.2f}", survival);
                         });
  try {
    skein::introspection::Decision decision;
    const AE_navigator::Route route = perform(entity_, task, &decision);
    // Whether it is back for the next part of this route is luck, and has no say in it.
    if (failure != failures_.end()) instead_ = accepted(decision);
    return route;
  } catch (const AE_navigator::NoRoute& refusal) {
    throw recon::NoRoute(refusal.reason);
  } catch (const AE_navigator::InvalidProblem& refusal) {
    throw recon::NoRoute(refusal.reason);
  } catch (const skein::Error& error) {
    throw recon::NoRoute(error.what());
  }
}

AE_navigator::Route StraightAhead::plan(const AE_navigator::Problem& problem) {
  AE_navigator::Route route;
  route.planner = "StraightAhead";
  route.waypoints = {problem.start, problem.goal};
  route.length_m = map_distance_m(problem.goal, problem.start);
  return route;
}

}  // namespace reconnaissance
