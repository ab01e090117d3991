#include "autopilot.hpp"

#include <algorithm>
#include <cmath>

#include "angles.hpp"

namespace reconnaissance {
namespace {

// At this airspeed the gains of surfaces are as they stand here, in full deflections.
constexpr double kTuned_m_s = 35;
// Slower than this nothing is gained by more of a surface.
constexpr double kSlowest_m_s = 12;
constexpr double kGreatestSurfaceGain = 4;

// Bank: a rate for each radian that is missing; a surface for each radian a second that is missing,
// and for the rate itself, which damping eats.
constexpr double kBankRate = 2;
constexpr double kAileronOfRate = 0.43, kAileronOfDamping = 0.385, kAileronOfBank = 0.3;
// Climb: likewise, and what it takes to learn the elevator of level flight.
constexpr double kClimbRate = 1, kGreatestPitchRate = 0.12;
constexpr double kElevatorOfRate = 0.34, kElevatorOfTurn = 3.4;
constexpr double kLevelElevator = 0.17, kGreatestTrim = 0.86;
// Speed: a throttle for each metre a second that is missing.
constexpr double kThrottleOfSpeed = 0.1, kThrottleOfDeficit = 0.02, kGreatestSpeedTrim = 0.4;
constexpr double kLevelThrottle = 0.75, kThrottleOfClimb = 3.5;
// Idle: the engine goes on.
constexpr double kIdle = 0.05;
// Below this airspeed the climb is given up for speed, by so much for each metre a second.
constexpr double kTooSlow_m_s = 20, kClimbOfSlowness = 0.03;

// On the ground.
constexpr double kRotation_rad = 0.14;
constexpr double kElevatorOfPitch = 4, kElevatorOfPitchTime = 2;
constexpr double kSteerOfCourse = 3, kSteerOfRate = 0.4;
constexpr double kCourseOfMetre = 0.03, kGreatestCourse_rad = 0.2;
constexpr double kAileronOnGround = 1.4;
constexpr double kBrakes = 0.6;
constexpr double kMoving_m_s = 2;

double limited(double value, double limit) { return std::clamp(value, -limit, limit); }

double surface_gain(double airspeed_m_s) {
  const double ratio = kTuned_m_s / std::max(airspeed_m_s, kSlowest_m_s);
  return std::min(ratio * ratio, kGreatestSurfaceGain);
}

}  // namespace

void Autopilot::begin() { *this = {}; }

Controls Autopilot::fly(const Airframe& airframe, const Demand& demand, const Motions& motions,
                        double seconds) {
  if (motions.on_ground) return roll(demand, motions, seconds);
  if (runway_rad_) begin();
  const double bank = limited(demand.bank_rad, airframe.greatest_bank_rad);
  const double slowness = std::max(0.0, kTooSlow_m_s - motions.airspeed_m_s);
  const double climb =
      limited(demand.climb_rad, airframe.greatest_climb_rad) - kClimbOfSlowness * slowness;
  const double speed = std::clamp(demand.airspeed_m_s, 0.0, airframe.never_exceed_m_s);
  return {aileron(bank, motions, airframe.greatest_bank_rate_rad_s, seconds),
          elevator(climb, motions, seconds), 0, throttle(speed, climb, motions, seconds), 0};
}

double Autopilot::aileron(double bank_rad, const Motions& motions, double greatest_rate,
                          double seconds) {
  const double missing = bank_rad - motions.bank_rad;
  bank_trim_ = limited(bank_trim_ + kAileronOfBank * missing * seconds, 0.2);
  const double rate = limited(kBankRate * missing, greatest_rate);
  const double gain = surface_gain(motions.airspeed_m_s);
  return limited(gain * (kAileronOfRate * (rate - motions.roll_rate) + bank_trim_) +
                     std::sqrt(gain) * kAileronOfDamping * rate,
                 1);
}

double Autopilot::elevator(double climb_rad, const Motions& motions, double seconds) {
  // A level turn is a pitch rate, too.
  const double turning = kGravity_m_s2 / std::max(motions.airspeed_m_s, kSlowest_m_s) *
                         std::tan(limited(motions.bank_rad, 1)) * std::sin(motions.bank_rad);
  const double wanted =
      turning + limited(kClimbRate * (climb_rad - motions.climb_rad), kGreatestPitchRate);
  const double missing = wanted - motions.pitch_rate;
  pitch_trim_ = limited(pitch_trim_ + kElevatorOfTurn * missing * seconds, kGreatestTrim);
  return limited(surface_gain(motions.airspeed_m_s) *
                     (kElevatorOfRate * missing + kLevelElevator + pitch_trim_),
                 1);
}

double Autopilot::throttle(double airspeed_m_s, double climb_rad, const Motions& motions,
                           double seconds) {
  const double missing = airspeed_m_s - motions.airspeed_m_s;
  const double wanted =
      kLevelThrottle + kThrottleOfClimb * climb_rad + kThrottleOfSpeed * missing + speed_trim_;
  // At its end a throttle teaches nothing.
  if ((wanted < 1 || missing < 0) && (wanted > kIdle || missing > 0))
    speed_trim_ = limited(speed_trim_ + kThrottleOfDeficit * missing * seconds, kGreatestSpeedTrim);
  return std::clamp(wanted, kIdle, 1.0);
}

Controls Autopilot::roll(const Demand& demand, const Motions& motions, double seconds) {
  if (!runway_rad_) {
    begin();
    runway_rad_ = motions.ground_m_s > kMoving_m_s ? motions.track_rad : motions.nose_rad;
  }
  const double gain = surface_gain(motions.airspeed_m_s);
  Controls controls;
  controls.aileron = limited(-kAileronOnGround * motions.bank_rad * gain, 1);
  aside_m_ += motions.ground_m_s * std::sin(motions.track_rad - *runway_rad_) * seconds;
  const double course_rad = *runway_rad_ - limited(kCourseOfMetre * aside_m_, kGreatestCourse_rad);
  controls.rudder = limited(
      kSteerOfCourse * wrapped(course_rad - motions.nose_rad) - kSteerOfRate * motions.yaw_rate, 1);
  if (demand.airspeed_m_s <= 0) {
    controls.brakes = kBrakes;
    return controls;
  }
  controls.throttle =
      std::clamp(0.5 + 0.2 * (demand.airspeed_m_s - motions.airspeed_m_s), kIdle, 1.0);
  if (demand.climb_rad <= 0) return controls;
  const double missing = kRotation_rad - motions.pitch_rad;
  pitch_trim_ = limited(pitch_trim_ + kElevatorOfPitchTime * missing * seconds, kGreatestTrim);
  controls.elevator = limited(
      gain * (kElevatorOfPitch * missing - kElevatorOfRate * motions.pitch_rate + pitch_trim_), 1);
  return controls;
}

}  // namespace reconnaissance
