#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "guidance.hpp"
#include "point_mass.hpp"
#include "sensors.hpp"

namespace reconnaissance {

/// A runway in local coordinates, used in the direction of its course.
struct Strip {
  Local threshold{};
  double course_rad = 0;
  double length_m = 0;
};

/// The point of the strip's centre line that lies so far beyond the threshold (before it, if that
/// is negative) and so high above it.
Local on_centre_line(const Strip& strip, double beyond_m, double above_m);

/// How a mission is flown.
struct FlightRules {
  double cruise_m_s = 60;
  /// On the last leg of a landing; 1.3 times the speed at which the aircraft stalls.
  double approach_m_s = 44;
  double greatest_bank_rad = 0.4363;   ///< 25 degrees: the airframe's limit is for emergencies.
  double greatest_climb_rad = 0.1047;  ///< 6 degrees.
  double rotate_m_s = 40;
  /// Above the runway, as high as a take-off climbs before it waits for a route.
  double take_off_height_m = 300;
  double flare_height_m = 12;
};

/// Who leads along lines and around circles.
struct Guidance {
  std::function<double(const Motion&, const Line&)> along;
  std::function<double(const Motion&, const Circle&)> around;
};

/// Flies an aircraft as it is told: takes off, follows the legs of a route, waits at its end, lands
/// and stops. Turns onto the next leg as early as its turning circle needs. A pure object.
class Pilot {
 public:
  enum class Mode { Parked, TakingOff, Following, Waiting, Approaching, Rolling, Landed };

  /// What the pilot sees.
  struct Sight {
    Measurement measured{};
    double radar_height_m = 0;
    bool on_ground = true;
  };

  Pilot(const FlightRules& rules, Guidance guidance)
      : rules_(rules), guidance_(std::move(guidance)) {}

  /// These return the reason why they cannot be done now; empty if they are.
  std::string take_off(const Strip& from);
  std::string follow(std::vector<Local> route);
  /// Circles at the height of the centre, until something else is ordered.
  std::string loiter(const Circle& circle);
  /// The route's last leg leads down to the strip.
  std::string land(std::vector<Local> route, const Strip& to);

  /// What it wants of the aircraft. Call it once a time step.
  Demand fly(const Sight& sight);

  Mode mode() const { return mode_; }
  /// Towards the end of the present leg, from a place; along the circle that was ordered; that of
  /// the runway before there is either.
  double route_course_rad(const Local& from) const;
  /// Which leg of the route is flown, from 0; after the last one their number.
  std::size_t leg() const { return leg_; }
  std::size_t legs() const { return route_.empty() ? 0 : route_.size() - 1; }

 private:
  bool is_on_ground() const {
    return mode_ == Mode::Parked || mode_ == Mode::Rolling || mode_ == Mode::Landed;
  }
  std::string begin(std::vector<Local> route, Mode mode);
  Demand fly_take_off(const Sight& sight);
  Demand fly_route(const Sight& sight);
  Demand fly_circle(const Sight& sight);
  Demand fly_landing(const Sight& sight);
  Demand flare(const Sight& sight, double bank_rad) const;
  Demand fly_leg(const Sight& sight, const Motion& motion, double speed_m_s) const;
  double low_m(const Motion& motion) const;
  bool advance_leg(const Motion& motion);
  Demand limited(double bank_rad, double climb_rad, double airspeed_m_s) const;
  Line line(std::size_t leg) const { return {route_[leg], route_[leg + 1]}; }

  FlightRules rules_;
  Guidance guidance_;
  Mode mode_ = Mode::Parked;
  Strip strip_{};
  std::vector<Local> route_;
  Circle circle_{};  // that is flown while it waits
  std::size_t leg_ = 0;
};

/// Above ground, below which an aircraft climbs: on its route, which keeps higher than that, or
/// while it avoids another aircraft; and on its way back to the route, where hills may rise as
/// steeply as it climbs.
inline constexpr double kLow_m = 240, kLowBeside_m = 400;

/// A demand, or, below a height above ground, at least a climb: the more the lower, and all that
/// the rules allow from 40 m below that height on.
Demand above_ground(const FlightRules& rules, const Demand& demand, const Pilot::Sight& sight,
                    double low_m);

/// What it takes to turn onto a course over ground and to climb as an advisory asks, within what
/// the rules allow, in place of what a route demands. Each part may be missing. Nobody has looked
/// at the ground beside the route: below 300 m above it no advisory leads down, and below kLow_m
/// the demand is to climb.
Demand advised(const FlightRules& rules, const Demand& demand, const Pilot::Sight& sight,
               std::optional<double> course_rad, std::optional<double> climb_m_s);

}  // namespace reconnaissance
