#include "ground_station.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

#include "ad_manager.idl.hpp"
#include "core/system/whole_file.hpp"
#include "flight_controller.idl.hpp"
#include "mission_text.hpp"
#include "navigation/route_checker/route_checker.hpp"
#include "navigation/routes/demo_problem.hpp"
#include "navigation/routes/flight_plan.hpp"
#include "navigation/routes/geojson.hpp"
#include "navigation/terrain/terrain_provider.hpp"
#include "skein/error.hpp"

using namespace std::chrono_literals;

namespace route_planning {
namespace {

using AE_flightControllerI::IFlightController;
using AE_navigator::Problem;
using skein::ParameterValues;

bool is_synthetic(const std::string& terrain) { return terrain.starts_with("synthetic:"); }

/// Other peers look for the file too, from folders of their own.
std::string name_for_all(const std::string& terrain) {
  return is_synthetic(terrain) ? terrain
                               : std::filesystem::absolute(terrain).lexically_normal().string();
}

/// The checker's own view of the ground.
skein::navigation::HeightGrid ground_of(const skein::navigation::Terrain& terrain) {
  if (!is_synthetic(terrain.name())) return skein::navigation::read_height_grid(terrain.name());
  return {terrain.rows(), terrain.columns(), terrain.north_spacing_m(), terrain.east_spacing_m(),
          terrain.heights_m()};
}

std::vector<std::string> names_in(const std::string& list) {
  std::vector<std::string> names;
  std::istringstream text(list);
  for (std::string name; std::getline(text, name, ',');) {
    const auto begin = name.find_first_not_of(' ');
    if (begin == std::string::npos) continue;
    names.push_back(name.substr(begin, name.find_last_not_of(' ') + 1 - begin));
  }
  return names;
}

AE_navigator::GroundPoint on_ground(const AE_navigator::Position& position) {
  return {position.north_m, position.east_m};
}

std::vector<AE_navigator::NoFlyZone> read_zones(const std::string& file,
                                                const skein::navigation::Terrain& terrain) {
  if (file.empty()) return {};
  constexpr std::size_t kLargest = std::size_t{64} << 20;
  return skein::navigation::zones_from_geojson(
      skein::read_whole_file("the zones in", file, kLargest), file, terrain);
}

void use(const AE_adManagerI::ThreatPicture& picture, Problem& problem) {
  problem.radar_sites = picture.radar_sites;
  problem.missile_sites = picture.missile_sites;
  problem.threat_epoch = picture.epoch;
}

/// Three times what the quickest planner has shown, 50 ms at least: hardly any other fits, on
/// whichever machine.
std::chrono::milliseconds hurry_of(const Answer& answer) {
  std::optional<double> quickest_ms;
  for (const auto& planner : answer.report.candidates) {
    if (planner.median_ms > 0)
      quickest_ms = std::min(quickest_ms.value_or(planner.median_ms), planner.median_ms);
  }
  return std::max(50ms,
                  std::chrono::milliseconds(std::lround(3 * quickest_ms.value_or(0) / 10) * 10));
}

double seconds(skein::Duration duration) { return std::chrono::duration<double>(duration).count(); }

std::string in_words(skein::Duration duration) { return fmt::format("{:g} s", seconds(duration)); }

}  // namespace

GroundStation::GroundStation(skein::Entity& entity, const ParameterValues& values)
    : entity_(entity),
      picture_(values.find<std::string>("Picture").value_or("route.html")),
      planners_(names_in(values.find<std::string>("Planners").value_or(""))),
      time_limit_(values.find<std::chrono::milliseconds>("Time limit").value_or(2s)),
      terrain_(skein::navigation::TerrainProvider().load(
          name_for_all(values.find<std::string>("Terrain").value_or("synthetic:7")))),
      terrain_title_(std::filesystem::path(terrain_->name()).filename().string()),
      zones_(read_zones(values.find<std::string>("Zones").value_or(""), *terrain_)),
      ground_(ground_of(*terrain_)),
      navigator_(entity),
      limits_(ask_flight_limits()) {
  skein::try_whole_file("the picture", picture_);
}

bool GroundStation::fly() {
  introduce();
  for (const auto step :
       {&GroundStation::brief_planners, &GroundStation::ask_with_time,
        &GroundStation::ask_for_what_was_shown, &GroundStation::ask_in_a_hurry,
        &GroundStation::ask_and_kill_the_planner, &GroundStation::ask_with_an_old_picture,
        &GroundStation::ask_for_the_unreachable, &GroundStation::draw}) {
    try {
      (this->*step)();
    } catch (const std::exception& error) {
      fail(error.what());
    }
  }
  return conclude();
}

void GroundStation::introduce() {
  const Problem problem = flyable(skein::navigation::demo_problem(*terrain_));
  print_heading("Route planning over " + terrain_title_);
  print_field("terrain",
              fmt::format("{:.0f} by {:.0f} km, {:.0f} to {:.0f} m high; {} radar sites, {} "
                          "no-fly zones",
                          terrain_->east_extent_m() / 1000, terrain_->north_extent_m() / 1000,
                          terrain_->lowest_m(), terrain_->highest_m(), problem.radar_sites.size(),
                          problem.no_fly_zones.size()));
  print_field("aircraft",
              fmt::format("{:.0f} m/s, climbs {:.0f} degrees, banks {:.0f} degrees, flies up "
                          "to {:.0f} m and no lower than {:.0f} m above ground",
                          limits_.speed_m_s, limits_.maximum_climb_angle_deg,
                          limits_.maximum_bank_angle_deg, limits_.maximum_altitude_m,
                          problem.minimum_height_above_ground_m));
}

void GroundStation::brief_planners() {
  const skein::Instant begin = entity_.clock().now();
  std::string names;
  for (const std::string& planner : planners_) {
    navigator_.train(planner, skein::navigation::demo_problem(*terrain_));
    names += (names.empty() ? "" : ", ") + planner;
  }
  if (names.empty()) return;
  print_field("briefing", fmt::format("{} know the terrain after {:.1f} s", names,
                                      seconds(entity_.clock().now() - begin)));
}

void GroundStation::ask_with_time() {
  print_heading("1  " + in_words(time_limit_) +
                " to think; planners are selected by what they declare");
  navigator_.select_by("declared");
  const Question question{"crossing", flyable(skein::navigation::demo_problem(*terrain_)),
                          time_limit_};
  accept(in_words(time_limit_) + ", by declaration", question,
         show(question, navigator_.ask(question)));
}

void GroundStation::ask_for_what_was_shown() {
  print_heading("2  The same question; planners are selected by what they have shown");
  navigator_.select_by("learned");
  const Question question{"crossing again", flyable(skein::navigation::demo_problem(*terrain_)),
                          time_limit_};
  const Answer answer = show(question, navigator_.ask(question));
  accept(in_words(time_limit_) + ", by experience", question, answer);
  hurry_ = hurry_of(answer);
}

void GroundStation::ask_in_a_hurry() {
  auto limit = hurry_;
  print_heading(fmt::format("3  {} milliseconds to think", limit.count()));
  Question question{"hurry", flyable(skein::navigation::demo_problem(*terrain_)), limit, 10};
  Answer answer = show(question, navigator_.ask(question));
  // What this machine could do in that time before, it may not when it is busy.
  while (!answer.route && !answer.proven && limit < time_limit_) {
    question.time_to_think = limit *= 2;
    question.id = fmt::format("hurry, {} ms", limit.count());
    print_field("again", fmt::format("with {} milliseconds", limit.count()));
    answer = show(question, navigator_.ask(question));
  }
  accept(fmt::format("{} ms", limit.count()), question, answer);
}

// The one that declares most thinks for long enough to be found at work.
void GroundStation::ask_and_kill_the_planner() {
  print_heading("4  " + in_words(time_limit_) + " to think, and the planner is killed");
  navigator_.select_by("declared");
  const Question question{"loss", flyable(skein::navigation::demo_problem(*terrain_)), time_limit_};
  Kill kill;
  const Answer answer = navigator_.ask_and_kill(question, kill);
  print_field("kill", fmt::format("{} (process {}) after {:.0f} ms", kill.planner, kill.pid,
                                  1000 * seconds(kill.planned_for)));
  accept("planner killed", question, show(question, answer));
  if (answer.route && answer.route->planner == kill.planner) {
    fail(kill.planner + " answered although it had been killed");
  }
  navigator_.brief(kill.planner, question.problem);
  print_field("back",
              fmt::format("{} was started again, and had planned a route {:.1f} s after its end",
                          kill.planner, seconds(entity_.clock().now() - kill.at)));
}

// A radar at the goal is off the air again, and missiles stand where the last route led: the
// question knows the one and not the other, the AD manager both.
void GroundStation::ask_with_an_old_picture() {
  print_heading("5  A cap on exposure, and threats that are not up to date");
  if (routes_.empty()) return fail("there is no route yet on which missiles could stand");
  navigator_.select_by("learned");
  auto ad_manager = entity_.connect<AE_adManagerI::IAdManager>({.timeout = 20s}).within(20s);
  Question question{"old picture", flyable(skein::navigation::demo_problem(*terrain_)),
                    time_limit_};
  Problem& problem = question.problem;
  const AE_navigator::Route& before = routes_.back().route;
  const std::string& name = problem.terrain;
  use(ad_manager.radar_found(name, {"Echo", on_ground(problem.goal), 20, 5000, 1}), problem);
  problem.exposure_cap_m = 3 * before.radar_exposure + 10'000;
  problem.kill_weight_m = 100'000;
  ad_manager.radar_silent(name, "Echo");
  const auto middle = before.waypoints[before.waypoints.size() / 2];
  const auto now = ad_manager.missiles_found(name, {"Sierra", on_ground(middle), 20, 4000, 0.02});
  print_field("threats",
              fmt::format("the question holds picture {}, with a radar at the goal; by picture {} "
                          "it is off the air, and missiles stand on the last route",
                          problem.threat_epoch, now.epoch));
  print_field("cap", fmt::format("{:.1f} km of exposure", problem.exposure_cap_m / 1000));
  missiles_ = now.missile_sites;
  const Answer answer = show(question, navigator_.ask(question));
  use(now, problem);
  accept("fresh picture", question, answer);
  if (answer.route && answer.route->threat_epoch != now.epoch)
    fail("the route was planned with old threats");
}

void GroundStation::ask_for_the_unreachable() {
  print_heading("6  A goal that cannot be reached");
  const Question question{"unreachable",
                          flyable(skein::navigation::unreachable_demo_problem(*terrain_)),
                          time_limit_ * 5 / 2};
  const Answer answer = show(question, navigator_.ask(question));
  if (answer.route) return fail("a route to the unreachable goal was returned");
  if (!answer.proven) return fail("the unreachable goal was not refused as such");
}

Answer GroundStation::show(const Question& question, Answer answer) {
  print_planners(answer);
  print_decision(answer);
  if (answer.route) {
    print_route(*answer.route);
  } else {
    print_refusal(answer);
  }
  print_time(answer, question.time_to_think);
  return answer;
}

void GroundStation::accept(const std::string& label, const Question& question,
                           const Answer& answer) {
  if (!answer.route) return fail("no route (" + label + ")");
  routes_.push_back({label + ": " + answer.route->planner, *answer.route});
  const auto violations = skein::navigation::check_route(question.problem, *answer.route, ground_);
  if (violations.empty()) return print_field("check", "valid");
  for (const auto& violation : violations) {
    print_field("check",
                fmt::format("INVALID ({}): {}", to_string(violation.rule), violation.text));
  }
  fail("the route checker refuses the route (" + label + ")");
}

void GroundStation::draw() {
  Problem problem = flyable(skein::navigation::demo_problem(*terrain_));
  problem.missile_sites = missiles_;
  skein::write_whole_file(
      "the picture", picture_,
      page_of(skein::navigation::route_picture(*terrain_, problem, routes_,
                                               "Route planning over " + terrain_title_)));
  if (terrain_->frame() && !routes_.empty()) write_for_others(problem);
}

void GroundStation::write_for_others(const Problem& problem) {
  const auto write = [&](const char* ending, const std::string& text) {
    written_.push_back(std::filesystem::path(picture_).replace_extension(ending));
    skein::write_whole_file("what is for maps and ground stations", written_.back(), text);
  };
  write(".geojson", skein::navigation::to_geojson(*terrain_, problem, routes_));
  const auto plan = skein::navigation::to_flight_plan(*terrain_, problem, routes_.back().route);
  write(".plan", plan.text);
  not_in_fence_ = plan.zones_left_out;
}

bool GroundStation::conclude() {
  print_heading("Result");
  print_field("picture", std::filesystem::absolute(picture_).lexically_normal().string());
  for (const auto& file : written_) {
    print_field("written", std::filesystem::absolute(file).lexically_normal().string());
  }
  for (const std::string& zone : not_in_fence_) {
    print_field("no fence", fmt::format("around '{}', which the route passes over or below", zone));
  }
  for (const std::string& failure : failures_) print_field("failed", failure);
  if (failures_.empty()) {
    print_field("done",
                fmt::format("{} routes, all valid; the unreachable goal was refused as such",
                            routes_.size()));
  }
  return failures_.empty();
}

void GroundStation::fail(const std::string& what) { failures_.push_back(what); }

AE_flightControllerI::FlightLimits GroundStation::ask_flight_limits() {
  return entity_.connect<IFlightController>({.timeout = 20s}).flight_limits();
}

Problem GroundStation::flyable(Problem problem) const {
  problem.limits = limits_;
  problem.no_fly_zones.insert(problem.no_fly_zones.end(), zones_.begin(), zones_.end());
  return problem;
}

}  // namespace route_planning
