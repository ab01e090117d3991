#include "conduct.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace reconnaissance {
namespace {

// Above the runway; then the first route is followed.
constexpr double kClimbedOut_m = 150;

}  // namespace

std::vector<Local> approach(const Strip& strip, const ApproachRules& rules) {
  const double height = (rules.final_m + rules.aim_m) * std::tan(rules.slope_rad);
  return {on_centre_line(strip, -rules.intercept_m, height),
          on_centre_line(strip, -rules.final_m, height), on_centre_line(strip, rules.aim_m, 0)};
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
      if (points_.empty()) return go_home("there is no point to fly over");
      enter(MissionPhase::Ingress, "the aircraft has climbed out");
      return Follow{{points_.front()}};
    case MissionPhase::Ingress:
      if (!flown) return std::nullopt;
      reached_ = 1;
      if (points_.size() == 1) return go_home("the only point is reached");
      enter(MissionPhase::Legs, "the first point is reached");
      return Follow{{points_.begin() + 1, points_.end()}};
    case MissionPhase::Legs:
      reached_ = std::max(reached_, std::min(1 + situation.leg, points_.size()));
      if (!flown) return std::nullopt;
      return go_home("the last point is reached");
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

std::optional<Conduct::Order> Conduct::refused(const std::string& reason) {
  const bool on_the_way = phase_ == MissionPhase::Ingress || phase_ == MissionPhase::Legs;
  if (on_the_way) return go_home(reason);
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
