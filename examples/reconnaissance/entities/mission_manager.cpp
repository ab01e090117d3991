#include "mission_manager.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "convert.hpp"
#include "deciding.hpp"
#include "mission/elements.hpp"
#include "pursuit.hpp"
#include "skein/error.hpp"
#include "threat_conversion.hpp"
#include "topics.hpp"
#include "tour_csps.hpp"

namespace reconnaissance {
namespace {

using namespace std::chrono_literals;

// Its providers have reported that they are ready; where there are several aircraft, at least those
// of one have.
constexpr auto kServicesWithin = 60s;
// Above the runway: higher than any hill, by as much as the camera likes.
constexpr double kCollectionHeight_m = 750;
// Of what is planned; and of all that was flown, by the weapons that were heard to guide.
constexpr double kLeastSurvival = 0.97;
constexpr double kLeastSurvived = 0.95;
// For so long it listens, and so places the weapons that reach the runway, before it takes off.
constexpr double kListens_s = 30;
// Of the take-off, over the runway and beyond, until a route is flown.
constexpr double kTakeOff_m = 3000;
// What bars a way: less is the uncertainty of a place that moves.
constexpr double kBarringHazard = 0.03;
// Of the straight way home, what it takes with turns, wind and the approach.
constexpr double kWayHomeShare = 2.5;
// A circle that has moved so far is told anew.
constexpr double kDrawn_m = 150;
// At both ends of a flight past an emitter, of the distance from it: its bearings shall cross.
constexpr double kBaselineShare = 0.5;
// An element that is missed is passed once more; a target that moves is searched once more again.
constexpr int kTries = 2;
constexpr int kSearches = 3;

int tries_for(const recon::Element& element) {
  return element.task == recon::ElementTask::FollowTarget ? kSearches : kTries;
}
// When threats reach over so much more or less ground than those that were planned with, another
// way is looked for where the present one is dangerous, and another tour where one was refused.
constexpr double kOtherThreats = 0.2;
// Nobody knows where an aircraft is that no sensors were heard of for so long.
constexpr double kBlind_s = 60;
// What the turns and the approach of a landing take, beside the way there.
constexpr double kLanding_s = 500;
// Of the route home, from the last: the approach, on which no other tour is looked for.
constexpr std::size_t kApproachLegs = 3;

recon::Phase phase_of(MissionPhase phase) {
  static_assert(static_cast<int>(MissionPhase::Aborted) == static_cast<int>(recon::Phase::Aborted));
  return static_cast<recon::Phase>(static_cast<int>(phase));
}

Pilot::Mode mode_of(recon::FlightMode mode) {
  static_assert(static_cast<int>(Pilot::Mode::Landed) ==
                static_cast<int>(recon::FlightMode::Landed));
  return static_cast<Pilot::Mode>(static_cast<int>(mode));
}

/// Whatever its height: a navigator may have led the way higher over the ground.
bool is_at_place_of(const recon::Position& point, const recon::Position& asked) {
  return point.latitude_deg == asked.latitude_deg && point.longitude_deg == asked.longitude_deg;
}

/// Of what guides at an aircraft now.
double kills_per_s(const recon::ThreatPicture& picture, const LocalFrame& frame,
                   const Local& aircraft) {
  double kills = 0;
  for (const recon::Threat& each : picture.threats)
    if (each.mode == recon::RadarMode::Guidance &&
        is_within(aircraft, discs_of({picture.tick, picture.epoch, {each}}, frame)))
      kills += kKills_per_s;
  return kills;
}

/// Whether it comes into reach on its way back to its route, as after an avoidance: nobody has
/// looked at what is beside.
bool strays(const recon::FlightState& state, const recon::Route& route, const LocalFrame& frame,
            const std::vector<ThreatDisc>& threats) {
  constexpr double kBeside_m = 500, kAhead_s = 25;
  if (state.avoiding || state.leg + 1 >= route.points.size()) return false;
  const Local own = local(frame, state.position);
  const Line leg{local(frame, route.points[state.leg]), local(frame, route.points[state.leg + 1])};
  const Motion motion{own.north_m, own.east_m, state.north_m_s, state.east_m_s};
  if (std::abs(along(leg, motion).right_m) < kBeside_m || is_within(own, threats)) return false;
  const Local ahead{own.north_m + kAhead_s * state.north_m_s,
                    own.east_m + kAhead_s * state.east_m_s, own.height_m};
  return hazard_of_leg(own, ahead, threats, 1) > 0;
}

double area_m2(const std::vector<ThreatDisc>& threats) {
  double area = 0;
  for (const ThreatDisc& each : threats) area += std::numbers::pi * each.radius_m * each.radius_m;
  return area;
}

recon::TourPass tour_pass(const CollectionPass& pass) {
  return {route_pose(pass.begin), route_pose(pass.end), pass.cost.seconds, pass.cost.fuel_kg,
          pass.cost.hazard};
}

}  // namespace

MissionManager::MissionManager(skein::Entity& entity, const skein::ParameterValues& values)
    : entity_(entity),
      fuel_reserve_kg_(values.find<double>("Fuel reserve").value_or(20)),
      endurance_s_(values.find<std::chrono::duration<double>>("Endurance").value_or(1h).count()),
      flight_(entity, topic::kFlightState),
      mode_(entity, topic::kMode, skein::TopicQos::state()),
      pictures_(entity, topic::kThreats, skein::TopicQos::state()),
      elements_(entity, topic::kElements, skein::TopicQos::state()),
      status_(entity.publisher<recon::MissionStatus>(topic::kStatus, skein::TopicQos::state())),
      taken_(entity.publisher<recon::RouteTaken>(topic::kRoute, skein::TopicQos::state())),
      member_(entity, values, [this](Tick tick) { manage(tick); }) {}

void MissionManager::start() {
  navigator_ =
      entity_.connect<recon::INavigator>({.timeout = kServicesWithin}).within(kUnlessAllHang);
  controller_ = entity_.connect<recon::IFlightController>({.timeout = kServicesWithin})
                    .within(kUnlessAllHang);
  limits_ = controller_->limits();
  cruise_.speed_m_s = limits_.speed_m_s;
  cruise_.turn_radius_m = limits_.turn_radius_m;
  cruise_.fuel_kg_s = limits_.fuel_kg_s;
  member_.start();
}

void MissionManager::begin(const recon::MissionOrder& order, std::int64_t tick) {
  std::lock_guard lock(mutex_);
  if (order_) throw recon::Refused("a mission is under way already");
  order_ = order;
  begins_ = tick + 1;
}

bool MissionManager::take_order(Tick tick) {
  if (conduct_) return true;
  std::lock_guard lock(mutex_);
  if (!order_ || tick < begins_) return false;
  runway_ = order_->runway;
  frame_.emplace(geodetic(runway_.threshold));
  conduct_.emplace(strip(*frame_, runway_));
  return true;
}

void MissionManager::manage(Tick tick) {
  if (!take_order(tick)) return;
  const auto state = flight_.at(tick);
  if (!state) return;
  const Conduct::Situation now = situation(tick, *state);
  if (state->sets_heard > 0) heard_ = tick;
  if (seconds_of(tick - heard_) > kBlind_s) {
    conduct_->abort(fmt::format("no set of sensors was heard for {:.0f} s", kBlind_s));
    return tell(tick);
  }
  if (const auto elements = elements_.at(tick)) {
    if (const Order order = reconsider(*state, *elements, now)) {
      carry_out(*order, tick, *state);
      return tell(tick);
    }
  }
  if (const Order order = conduct_->decide(now)) carry_out(*order, tick, *state);
  tell(tick);
}

Conduct::Situation MissionManager::situation(Tick tick, const recon::FlightState& state) {
  if (const auto picture = pictures_.at(tick)) {
    threats_ = discs_of(*picture, *frame_);
    certain_ = discs_of(*picture, *frame_, certain_reach_m);
    suffered_.hazard +=
        seconds_of(tick - looked_) * kills_per_s(*picture, *frame_, local(*frame_, state.position));
  }
  looked_ = tick;
  const auto mode = mode_.at(tick);
  Conduct::Situation now;
  return_home_.reset();
  if (const auto cause = excess(suffered_, {.least_survival = kLeastSurvived}))
    return_home_ = "a weapon guides, and what was flown " + *cause;
  if (mode && mode->flight >= recon::FlightOrder::ReturnHome) return_home_ = mode->cause;
  nothing_new_ = mode && mode->flight >= recon::FlightOrder::BeginNothingNew;
  now.all_fine =
      mode && mode->mode == recon::Mode::Normal && !nothing_new_ && seconds_of(tick) >= kListens_s;
  now.mode = mode_of(state.mode);
  now.height_m = state.position.height_m;
  if (state.route != route_.number) return now;
  now.leg = state.leg;
  now.legs = state.legs;
  // The points that were asked for stand in the route among those that lead to them.
  for (std::size_t i = 1; i <= state.leg && i < route_.points.size(); ++i) {
    const bool asked =
        now.reached < through_.size() &&
        is_at_place_of(route_.points[i], position(*frame_, through_[now.reached].place));
    if (asked) ++now.reached;
  }
  // Two points for each element; on the way home there are none.
  while (passed_ < tour_.size() && now.reached >= 2 * (passed_ + 1)) ++tries_[tour_[passed_++]];
  return now;
}

MissionManager::Order MissionManager::reconsider(const recon::FlightState& state,
                                                 const recon::ElementList& elements,
                                                 const Conduct::Situation& now) {
  const MissionPhase phase = conduct_->phase();
  if (phase != MissionPhase::Egress) waits_ = false;
  if (return_home_ && phase != MissionPhase::Egress) return conduct_->call_back(*return_home_);
  if (phase == MissionPhase::BuiltInTest) {
    if (const auto cause = contradiction(state, elements))
      return conduct_->give_up("the order contradicts itself: " + *cause);
    if (!now.all_fine || !conduct_->tour().empty()) return {};
    if (const auto cause = excess(take_off_and_landing(), {.least_survival = kLeastSurvival}))
      return conduct_->give_up("weapons reach the runway: take-off and landing " + *cause);
    tour(state, elements, "planned");
    if (conduct_->tour().empty()) {  // in the air weapons are placed better
      threats_ = certain_;
      tour(state, elements, "planned");
    }
    const bool none = conduct_->tour().empty() && !elements.elements.empty();
    return none ? conduct_->give_up(
                      "no element can be collected within the time, fuel and risk that are allowed")
                : Order{};
  }
  if (conduct_->may_try_again() && !return_home_)
    if (Order order = pursue(state, elements)) return order;
  const bool barred =
      now.legs > 0 && (is_barred(state) || strays(state, route_, *frame_, threats_));
  if (may_look_again(now, state.tick)) {
    look_again_s_ *= 2;
    const bool others = others_threaten();
    if (Order order =
            tour(state, elements, others ? "threats are known better" : "a tour may be left here"))
      return order;
  }
  if (phase == MissionPhase::Egress)
    return barred ? conduct_->go_home_another_way("a threat bars the way home")
                  : wait_or_land(state, elements);
  if (phase != MissionPhase::Ingress && phase != MissionPhase::Collection) return {};
  if (Order order = pursue(state, elements)) return order;
  if (circle_) return {};
  if (barred) return tour(state, elements, "a threat bars the way");
  // No more bearings are wanted of an emitter that is placed.
  for (std::size_t i = passed_; i < tour_.size(); ++i) {
    const auto found = std::ranges::find(elements.elements, tour_[i], &recon::Element::name);
    if (found != elements.elements.end() && found->task == recon::ElementTask::LocateEmitter &&
        found->collected)
      return tour(state, elements, found->name + " is located");
  }
  if (elements.elements.size() > planned_for_ && !nothing_new_)
    return tour(state, elements, elements.elements.back().name + " was not reported");
  const bool flown = now.legs > 0 && now.leg >= now.legs;
  const bool missed = std::ranges::any_of(
      elements.elements, [&](const recon::Element& each) { return is_missed(each); });
  if (!flown || !missed) return {};
  return nothing_new_ ? conduct_->refused("an element was missed, and nothing new is begun")
                      : tour(state, elements, "an element was missed");
}

MissionManager::Order MissionManager::pursue(const recon::FlightState& state,
                                             const recon::ElementList& elements) {
  const auto target = std::ranges::find_if(elements.elements, [](const recon::Element& each) {
    return each.task == recon::ElementTask::FollowTarget && each.found && !each.collected;
  });
  if (target == elements.elements.end()) {
    if (!circle_) return {};
    circle_.reset();
    const bool any_left = std::ranges::any_of(
        elements.elements, [](const recon::Element& each) { return !each.collected; });
    return tour(state, elements, any_left ? "the target is lost" : "followed as long as ordered");
  }
  if (circle_ && !is_due(topic::kElements.period, state.tick)) return {};
  const Local own = local(*frame_, state.position), place = local(*frame_, target->line.front());
  const double height_m = runway_.threshold.height_m + kCollectionHeight_m;
  if (left_s(state.tick) < kWayHomeShare * std::hypot(own.north_m, own.east_m) / cruise_.speed_m_s)
    return conduct_->give_up("the endurance suffices for the way home and no more");
  const auto circle =
      ask_circle(entity_, target->name,
                 {{place.north_m, place.east_m, target->north_m_s, target->east_m_s},
                  {own.north_m, own.east_m, state.north_m_s, state.east_m_s},
                  target->stand_off_m,
                  greatest_distance_m(*target, kCollectionHeight_m),
                  cruise_.turn_radius_m,
                  threats_});
  if (!circle) {
    circle_.reset();
    return conduct_->give_up(target->name + " cannot be watched from any safe circle");
  }
  const bool begins = !circle_;
  circle_ = circle;
  circle_->centre.height_m = height_m;
  return conduct_->loiter(*circle_,
                          begins ? target->name + " is found, and followed" : conduct_->reason());
}

/// Not collected, and worth another pass.
bool MissionManager::is_missed(const recon::Element& element) const {
  const auto passes = tries_.find(element.name);
  return !element.collected && (passes == tries_.end() || passes->second < tries_for(element));
}

MissionManager::Order MissionManager::wait_or_land(const recon::FlightState& state,
                                                   const recon::ElementList& elements) {
  if (!conduct_->may_try_again() || !is_due(topic::kElements.period, state.tick)) return {};
  const bool wanted = std::ranges::any_of(
      elements.elements, [&](const recon::Element& each) { return is_missed(each); });
  const bool may = wanted && may_wait(state);
  if (may) {
    if (auto circle = waiting_circle(local(*frame_, state.position), threats_)) {
      waits_ = true;
      circle->centre.height_m = runway_.threshold.height_m + kCollectionHeight_m;
      return conduct_->wait(*circle, "waits until a tour may be flown");
    }
  }
  if (!std::exchange(waits_, false)) return {};
  return may ? conduct_->go_home_another_way("there is no room to wait for a tour")
             : conduct_->go_home_for_good("there is nothing left to wait for");
}

/// While there is time and fuel for more than the way home.
bool MissionManager::may_wait(const recon::FlightState& state) const {
  const Local own = local(*frame_, state.position);
  const double home_s =
      kLanding_s + kWayHomeShare * std::hypot(own.north_m, own.east_m) / cruise_.speed_m_s;
  return !return_home_ && left_s(state.tick) > home_s &&
         state.fuel_kg > fuel_reserve_kg_ + home_s * cruise_.fuel_kg_s;
}

/// Of the time for which it may be in the air.
double MissionManager::left_s(Tick tick) const {
  return endurance_s_ - (took_off_ ? seconds_of(tick - *took_off_) : 0);
}

std::optional<std::string> MissionManager::contradiction(const recon::FlightState& state,
                                                         const recon::ElementList& elements) const {
  const Local own = local(*frame_, state.position);
  for (const recon::Element& each : elements.elements) {
    const Local place = middle_of(locals(*frame_, each.line));
    const auto cause = contradiction_in(each, map_distance_m(place, own), cruise_, endurance_s_,
                                        kCollectionHeight_m);
    if (cause) return cause;
  }
  return std::nullopt;
}

/// What is flown in any case.
FlightCost MissionManager::take_off_and_landing() const {
  const Strip runway = strip(*frame_, runway_);
  std::vector<Local> way;
  for (const WayPoint& each : approach(runway, {})) way.push_back(each.place);
  way.push_back(on_centre_line(runway, kTakeOff_m, 0));
  FlightCost cost;
  cost.hazard = hazard_of_way(way, threats_, cruise_.speed_m_s);
  return cost;
}

void MissionManager::loiter(const Circle& circle, Tick tick) {
  controller_->loiter(position(*frame_, circle.centre),
                      circle.clockwise ? circle.radius_m : -circle.radius_m, tick);
  if (!route_.points.empty() && route_.planner == kCircle &&
      map_distance_m(told_circle_, circle.centre) < kDrawn_m)
    return;
  told_circle_ = circle.centre;
  route_ = drawn(circle, *frame_, route_.number + 1);
  taken_.publish({tick, route_});
}

/// Whether the rest of the route leads through what a weapon reaches, where a way around would be
/// another one than was taken with what was known then.
bool MissionManager::is_barred(const recon::FlightState& state) const {
  std::vector<Local> rest{local(*frame_, state.position)};
  for (std::size_t i = state.leg + 1; i < route_.points.size(); ++i)
    rest.push_back(local(*frame_, route_.points[i]));
  const double hazard = hazard_of_way(rest, threats_, cruise_.speed_m_s);
  return hazard > barring_hazard_ || (hazard > kBarringHazard && others_threaten());
}

/// Whether threats reach over much more or less ground than those that were planned with last.
bool MissionManager::others_threaten() const {
  return std::abs(area_m2(threats_) - planned_area_m2_) > kOtherThreats * planned_area_m2_;
}

/// Who flies home for want of a tour looks for one when threats are known better, and, ever more
/// seldom, where it has come meanwhile.
bool MissionManager::may_look_again(const Conduct::Situation& now, Tick tick) const {
  if (!conduct_->may_try_again() || return_home_ || nothing_new_) return false;
  const bool waited = seconds_of(tick) - planned_s_ >= (waits_ ? kLookAgain_s : look_again_s_);
  return others_threaten() || (waited && (waits_ || now.leg + kApproachLegs < now.legs));
}

MissionManager::Order MissionManager::tour(const recon::FlightState& state,
                                           const recon::ElementList& elements,
                                           const std::string& why) {
  planned_for_ = elements.elements.size();
  planned_area_m2_ = area_m2(threats_);
  planned_s_ = seconds_of(state.tick);
  recon::TourProblem problem;
  // Who is within reach has to get out before anything else, which no tour can spare him.
  const Local here = out_of_reach(local(*frame_, state.position), threats_);
  const WayPoint home = approach(strip(*frame_, runway_), {}).front();
  problem.start = {here.north_m, here.east_m, state.heading_rad};
  problem.landing = {home.place.north_m, home.place.east_m, runway_.course_rad};
  // At both ends of a pass there has to be room for a turn.
  std::vector<ThreatDisc> wide = threats_;
  for (ThreatDisc& each : wide) each.radius_m += cruise_.turn_radius_m;
  for (const recon::Element& each : elements.elements) {
    if (!is_missed(each)) continue;
    recon::TourTask& task = problem.tasks.emplace_back(each.name, each.priority);
    for (const CollectionPass& pass : passes_of(each, wide)) task.passes.push_back(tour_pass(pass));
  }
  problem.weapons = weapons_of(threats_);
  problem.speed_m_s = cruise_.speed_m_s;
  problem.turn_radius_m = cruise_.turn_radius_m;
  problem.fuel_kg_s = cruise_.fuel_kg_s;
  problem.endurance_s = left_s(state.tick);
  problem.fuel_kg = state.fuel_kg - fuel_reserve_kg_;
  problem.least_survival = kLeastSurvival;

  const auto found = problem.tasks.empty() ? std::nullopt : ask_tour(problem);
  std::vector<WayPoint> points;
  tour_.clear();
  passed_ = 0;
  const double height_m = runway_.threshold.height_m + kCollectionHeight_m;
  for (const recon::TourStop& stop : found ? found->stops : std::vector<recon::TourStop>{}) {
    const recon::TourTask& task = problem.tasks.at(stop.task);
    const recon::TourPass& pass = task.passes.at(stop.pass);
    points.push_back({{pass.begin.north_m, pass.begin.east_m, height_m}, false});
    points.push_back({{pass.end.north_m, pass.end.east_m, height_m}, true});
    tour_.push_back(task.element);
  }
  return conduct_->fly(
      points, fmt::format("{}: {}", why,
                          tour_.empty() ? "home" : fmt::format("{}", fmt::join(tour_, ", "))));
}

/// Past what is reconnoitred. A target is searched along its road as far as one can fly there.
std::vector<CollectionPass> MissionManager::passes_of(const recon::Element& element,
                                                      const std::vector<ThreatDisc>& wide) const {
  const auto line = locals(*frame_, element.line);
  PassRules rules;
  if (element.task == recon::ElementTask::LocateEmitter) {
    rules.aside_m = aside_m(line.front(), element.stand_off_m, wide);
    rules.before_m = rules.after_m = kBaselineShare * rules.aside_m;
  }
  if (element.task != recon::ElementTask::FollowTarget)
    return passes_by(line, wide, cruise_, rules);
  std::vector<ThreatDisc> beyond = wide;
  for (ThreatDisc& each : beyond) each.radius_m += rules.after_m;
  return passes_by(part_out_of_reach(line, beyond), wide, cruise_, rules);
}

std::optional<recon::Tour> MissionManager::ask_tour(const recon::TourProblem& problem) {
  skein::Task<recon::ITourPlanner, recon::Tour> task;
  task.request = fmt::format("tour {}", ++tours_);
  task.features = {{"elements", static_cast<double>(problem.tasks.size())},
                   {"weapons", static_cast<double>(problem.weapons.size())}};
  task.run = [&](recon::ITourPlanner::Proxy& planner, skein::Duration) {
    return planner.plan(problem);
  };
  task.evaluate.check("is a tour", [&](const recon::Tour& tour) -> std::optional<std::string> {
    for (const recon::TourStop& stop : tour.stops) {
      if (stop.task >= problem.tasks.size() || stop.pass >= problem.tasks[stop.task].passes.size())
        return "it has a stop that nobody asked for";
    }
    return std::nullopt;
  });
  task.evaluate.check(
      "keeps the limits", [&](const recon::Tour& tour) -> std::optional<std::string> {
        return excess({tour.seconds, tour.fuel_kg, tour.hazard},
                      {problem.endurance_s, problem.fuel_kg, problem.least_survival});
      });
  try {
    return decide(entity_, task);
  } catch (const skein::Error&) {
    return std::nullopt;  // Without a tour it goes home.
  }
}

void MissionManager::carry_out(const Conduct::Order& order, Tick tick,
                               const recon::FlightState& state) {
  std::string refusal;
  try {
    if (std::holds_alternative<Conduct::TakeOff>(order)) {
      controller_->take_off(runway_, tick);
      took_off_ = tick;
      return;
    }
    if (const auto* circling = std::get_if<Conduct::Loiter>(&order))
      return loiter(circling->circle, tick);
    if (const auto* follow = std::get_if<Conduct::Follow>(&order)) {
      // Nor is the way out of reach refused to who is within.
      const bool within = is_within(local(*frame_, state.position), threats_);
      controller_->follow(ask_route(follow->through, tick, state, within ? 0 : kLeastSurvival),
                          tick);
    } else {
      controller_->land(ask_route(std::get<Conduct::Land>(order).through, tick, state, 0), runway_,
                        tick);
    }
    taken_.publish({tick, route_});
    return;
  } catch (const recon::NoRoute& error) {
    refusal = error.reason;
  } catch (const recon::Refused& error) {
    refusal = error.reason;
  } catch (const skein::Error& error) {
    refusal = error.what();
  }
  if (const auto instead = conduct_->refused(refusal)) carry_out(*instead, tick, state);
}

recon::Route MissionManager::ask_route(const std::vector<WayPoint>& through, Tick tick,
                                       const recon::FlightState& state, double least_survival) {
  recon::RouteRequest request{tick, state.position, std::atan2(state.east_m_s, state.north_m_s),
                              {},   limits_,        least_survival};
  for (const WayPoint& each : through)
    request.through.push_back({position(*frame_, each.place), each.straight});
  if (conduct_->phase() == MissionPhase::Egress) tour_.clear();
  // By numbers of its own: a navigator that was restarted counts anew.
  const std::uint32_t number = route_.number + 1;
  route_ = navigator_->plan(request);
  // The way home from a tour that was refused was planned with others than that.
  if (return_home_ || !conduct_->may_try_again()) planned_area_m2_ = area_m2(threats_);
  route_.number = number;
  through_ = through;
  // What remains of a way that leads around as well as it can bars nothing.
  std::vector<Local> way = locals(*frame_, route_.points);
  barring_hazard_ = hazard_of_way(way, threats_, cruise_.speed_m_s) + kBarringHazard;
  return route_;
}

void MissionManager::tell(Tick tick) {
  recon::MissionStatus status{tick, phase_of(conduct_->phase()), conduct_->reason(),
                              static_cast<std::uint32_t>(conduct_->points_reached() / 2),
                              static_cast<std::uint32_t>(conduct_->tour().size() / 2)};
  if (told_ && told_->phase == status.phase && told_->passed == status.passed &&
      told_->reason == status.reason)
    return;
  told_ = status;
  status_.publish(status);
}

}  // namespace reconnaissance
