#include "conduct.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace reconnaissance {
namespace {

// Above the runway; then the first route is followed.
constexpr double kClimbedOut_m = 150;

}  // namespace

std::vector<WayPoint> approach(const Strip& strip, const ApproachRules& rules) {
  const double height = (rules.final_m + rules.aim_m) * std::tan(rules.slope_rad);
  return {{on_centre_line(strip, -rules.intercept_m, height), false},
          {on_centre_line(strip, -rules.final_m, height), true},
          {on_centre_line(strip, rules.aim_m, 0), true}};
}

std::optional<Conduct::Order> Conduct::decide(const Situation& situation) {
  const bool flown = situation.legs > 0 && situation.leg >= situation.legs;
  switch (phase_) {
    case MissionPhase::BuiltInTest:
      if (!situation.all_fine) return std::nullopt;
      enter(MissionPhase::TakeOff, "everybody is fine");
      return TakeOff{};
    case MissionPhase::TakeOff:
      if (situation.mode != Pilot::Mode::TakingOff ||
          situation.height_m < strip_.threshold.height_m + kClimbedOut_m)
        return std::nullopt;
      if (tour_.empty()) return go_home("there is nothing to collect");
      enter(MissionPhase::Ingress, why_this_tour_);
      return Follow{tour_};
    case MissionPhase::Ingress:
      reached_ = situation.reached;
      if (reached_ == 0 && !flown) return std::nullopt;
      enter(MissionPhase::Collection, "the first element is near");
      return std::nullopt;
    case MissionPhase::Collection:
      reached_ = situation.reached;
      if (!flown) return std::nullopt;
      return go_home("the tour is flown");
    case MissionPhase::Egress:
      if (situation.legs > 0 && situation.leg + 1 >= situation.legs)
        enter(MissionPhase::Landing, "the aircraft descends to the runway");
      return std::nullopt;
    case MissionPhase::Landing:
      if (situation.mode == Pilot::Mode::Landed)
        enter(MissionPhase::Complete, "the aircraft has landed and stands");
      return std::nullopt;
    case MissionPhase::Complete:
    case MissionPhase::Aborted:
      break;
  }
  return std::nullopt;
}

std::optional<Conduct::Order> Conduct::fly(std::vector<WayPoint> tour, const std::string& reason) {
  tour_ = std::move(tour);
  why_this_tour_ = reason;
  reached_ = 0;
  if (!is_under_way() && (tour_.empty() || !may_try_again())) return std::nullopt;
  sent_home_ = tour_.empty();
  if (sent_home_) return go_home(reason);
  enter(MissionPhase::Ingress, reason);
  return Follow{tour_};
}

std::optional<Conduct::Order> Conduct::loiter(const Circle& circle, const std::string& reason) {
  if (!is_under_way() && !may_try_again()) return std::nullopt;
  enter(MissionPhase::Collection, reason);
  return Loiter{circle};
}

std::optional<Conduct::Order> Conduct::give_up(const std::string& reason) {
  if (is_under_way()) return go_home(reason);
  if (phase_ == MissionPhase::BuiltInTest) enter(MissionPhase::Aborted, reason);
  return std::nullopt;
}

std::optional<Conduct::Order> Conduct::call_back(const std::string& reason) {
  sent_home_ = is_under_way();
  return give_up(reason);
}

std::optional<Conduct::Order> Conduct::wait(const Circle& circle, const std::string& reason) {
  if (!may_try_again()) return std::nullopt;
  reason_ = reason;
  return Loiter{circle};
}

std::optional<Conduct::Order> Conduct::go_home_for_good(const std::string& reason) {
  sent_home_ = false;
  return go_home_another_way(reason);
}

std::optional<Conduct::Order> Conduct::go_home_another_way(const std::string& reason) {
  return phase_ == MissionPhase::Egress ? go_home(reason) : std::nullopt;
}

std::optional<Conduct::Order> Conduct::refused(const std::string& reason) {
  if (is_under_way()) {
    sent_home_ = true;
    return go_home(reason);
  }
  enter(MissionPhase::Aborted, reason);
  return std::nullopt;
}

std::optional<Conduct::Order> Conduct::go_home(const std::string& reason) {
  enter(MissionPhase::Egress, reason);
  return Land{approach(strip_, rules_)};
}

void Conduct::enter(MissionPhase phase, std::string reason) {
  phase_ = phase;
  reason_ = std::move(reason);
}

}  // namespace reconnaissance
