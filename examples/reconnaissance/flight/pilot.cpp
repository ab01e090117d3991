#include "pilot.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "angles.hpp"

namespace reconnaissance {
namespace {

constexpr double kStanding_m_s = 0.5;
// As long as a runway's centre line is followed: further than anybody flies before a route comes.
constexpr double kCentreLine_m = 50'000;
// In the flare the rate of descent falls with the height, to a touch-down that does no harm.
constexpr double kFlareTime_s = 4;
constexpr double kTouchDown_m_s = 0.6;

Motion motion_of(const Measurement& measured) {
  return {measured.position.north_m, measured.position.east_m, measured.north_m_s,
          measured.east_m_s};
}

}  // namespace

Local on_centre_line(const Strip& strip, double beyond_m, double above_m) {
  return {strip.threshold.north_m + beyond_m * std::cos(strip.course_rad),
          strip.threshold.east_m + beyond_m * std::sin(strip.course_rad),
          strip.threshold.height_m + above_m};
}

std::string Pilot::take_off(const Strip& from) {
  if (mode_ != Mode::Parked) return "the aircraft is not parked";
  strip_ = from;
  mode_ = Mode::TakingOff;
  return "";
}

std::string Pilot::follow(std::vector<Local> route) {
  return begin(std::move(route), Mode::Following);
}

std::string Pilot::land(std::vector<Local> route, const Strip& to) {
  const std::string reason = begin(std::move(route), Mode::Approaching);
  if (reason.empty()) strip_ = to;
  return reason;
}

std::string Pilot::loiter(const Circle& circle) {
  if (is_on_ground()) return "the aircraft is on the ground";
  route_.clear();
  leg_ = 0;
  circle_ = circle;
  mode_ = Mode::Waiting;
  return "";
}

std::string Pilot::begin(std::vector<Local> route, Mode mode) {
  if (route.size() < 2) return "a route has two points or more";
  if (is_on_ground()) return "the aircraft is on the ground";
  route_ = std::move(route);
  leg_ = 0;
  mode_ = mode;
  return "";
}

Demand Pilot::fly(const Sight& sight) {
  switch (mode_) {
    case Mode::TakingOff:
      return fly_take_off(sight);
    case Mode::Following:
      return fly_route(sight);
    case Mode::Waiting:
      return fly_circle(sight);
    case Mode::Approaching:
    case Mode::Rolling:
      return fly_landing(sight);
    case Mode::Parked:
    case Mode::Landed:
      break;
  }
  return {};
}

Demand Pilot::fly_take_off(const Sight& sight) {
  const Line ahead{strip_.threshold, on_centre_line(strip_, kCentreLine_m, 0)};
  const Motion motion = motion_of(sight.measured);
  if (sight.on_ground) {
    const bool fast = sight.measured.airspeed_m_s >= rules_.rotate_m_s;
    return {0, fast ? rules_.greatest_climb_rad : 0, rules_.cruise_m_s};
  }
  const double level_m = strip_.threshold.height_m + rules_.take_off_height_m;
  const Line level{{0, 0, level_m}, {1, 0, level_m}};
  return limited(
      guidance_.along(motion, ahead),
      climb_rad(level, motion, sight.measured.position.height_m, sight.measured.airspeed_m_s),
      rules_.cruise_m_s);
}

Demand Pilot::fly_route(const Sight& sight) {
  const Motion motion = motion_of(sight.measured);
  if (!advance_leg(motion)) {
    mode_ = Mode::Waiting;
    circle_ = {route_.back(), 1.5 * turn_radius_m(rules_.cruise_m_s, rules_.greatest_bank_rad),
               true};
    return fly_circle(sight);
  }
  return above_ground(rules_, fly_leg(sight, motion, rules_.cruise_m_s), sight, low_m(motion));
}

Demand Pilot::fly_leg(const Sight& sight, const Motion& motion, double speed_m_s) const {
  return limited(
      guidance_.along(motion, line(leg_)),
      climb_rad(line(leg_), motion, sight.measured.position.height_m, sight.measured.airspeed_m_s),
      speed_m_s);
}

/// Beside its leg the aircraft meets ground at which nobody has looked, and climbs in time.
double Pilot::low_m(const Motion& motion) const {
  constexpr double kBeside_m = 500;
  return std::abs(along(line(leg_), motion).right_m) > kBeside_m ? kLowBeside_m : kLow_m;
}

Demand Pilot::fly_circle(const Sight& sight) {
  const Motion motion = motion_of(sight.measured);
  const Line level{circle_.centre, circle_.centre};
  const Demand demand = limited(
      guidance_.around(motion, circle_),
      climb_rad(level, motion, sight.measured.position.height_m, sight.measured.airspeed_m_s),
      rules_.cruise_m_s);
  return above_ground(rules_, demand, sight, kLow_m);
}

Demand Pilot::fly_landing(const Sight& sight) {
  if (sight.on_ground) {
    const double speed = std::hypot(sight.measured.north_m_s, sight.measured.east_m_s);
    mode_ = speed < kStanding_m_s ? Mode::Landed : Mode::Rolling;
    return {};
  }
  const Motion motion = motion_of(sight.measured);
  if (leg_ + 1 < legs()) advance_leg(motion);
  const bool last = leg_ + 1 == legs();
  if (last && sight.radar_height_m < rules_.flare_height_m)
    return flare(sight, guidance_.along(motion, line(leg_)));
  const Demand demand = fly_leg(sight, motion, last ? rules_.approach_m_s : rules_.cruise_m_s);
  const bool straight_down = leg_ + 2 >= legs();
  return straight_down ? demand : above_ground(rules_, demand, sight, low_m(motion));
}

Demand Pilot::flare(const Sight& sight, double bank_rad) const {
  const double sink_m_s = std::max(kTouchDown_m_s, sight.radar_height_m / kFlareTime_s);
  const double airspeed = std::max(sight.measured.airspeed_m_s, 1.0);
  return limited(bank_rad, -std::asin(std::min(1.0, sink_m_s / airspeed)), rules_.approach_m_s);
}

/// Whether there is a leg to fly.
bool Pilot::advance_leg(const Motion& motion) {
  for (; leg_ < legs(); ++leg_) {
    const Along here = along(line(leg_), motion);
    const double speed = std::hypot(motion.north_m_s, motion.east_m_s);
    const double lead = leg_ + 1 < legs()
                            ? turn_lead_m(turn_radius_m(speed, rules_.greatest_bank_rad),
                                          line(leg_), line(leg_ + 1))
                            : 0;
    if (here.along_m < here.length_m - lead) return true;
  }
  return false;
}

Demand Pilot::limited(double bank_rad, double climb_rad, double airspeed_m_s) const {
  return {std::clamp(bank_rad, -rules_.greatest_bank_rad, rules_.greatest_bank_rad),
          std::clamp(climb_rad, -rules_.greatest_climb_rad, rules_.greatest_climb_rad),
          airspeed_m_s};
}

double Pilot::route_course_rad(const Local& from) const {
  if (route_.empty() && mode_ == Mode::Waiting) {
    const double outward_rad = course_between_rad(circle_.centre, from);
    return outward_rad + (circle_.clockwise ? 1 : -1) * std::numbers::pi / 2;
  }
  if (route_.empty()) return strip_.course_rad;
  const Local& to = route_[std::min(leg_ + 1, route_.size() - 1)];
  return course_between_rad(from, to);
}

Demand above_ground(const FlightRules& rules, const Demand& demand, const Pilot::Sight& sight,
                    double low_m) {
  constexpr double kFull_m = 40;
  Demand instead = demand;
  const double low = std::clamp((low_m - sight.radar_height_m) / kFull_m, 0.0, 1.0);
  if (low > 0) instead.climb_rad = std::max(demand.climb_rad, low * rules.greatest_climb_rad);
  return instead;
}

Demand advised(const FlightRules& rules, const Demand& demand, const Pilot::Sight& sight,
               std::optional<double> course_rad, std::optional<double> climb_m_s) {
  // The bank for each radian that the course is off.
  constexpr double kGain = 1.5;
  // Above ground.
  constexpr double kLeastDescent_m = 300;
  const Measurement& measured = sight.measured;
  const auto climb_rad = [&](double wanted_m_s) {
    const double rad =
        std::asin(std::clamp(wanted_m_s / std::max(measured.airspeed_m_s, 1.0), -1.0, 1.0));
    return std::clamp(rad, -rules.greatest_climb_rad, rules.greatest_climb_rad);
  };
  Demand instead = demand;
  if (course_rad) {
    const double off_rad = wrapped(*course_rad - std::atan2(measured.east_m_s, measured.north_m_s));
    instead.bank_rad =
        std::clamp(kGain * off_rad, -rules.greatest_bank_rad, rules.greatest_bank_rad);
  }
  if (climb_m_s && (*climb_m_s >= 0 || sight.radar_height_m >= kLeastDescent_m))
    instead.climb_rad = climb_rad(*climb_m_s);
  return above_ground(rules, instead, sight, kLow_m);
}

}  // namespace reconnaissance
