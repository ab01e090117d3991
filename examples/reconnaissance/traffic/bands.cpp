#include "traffic/bands.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace reconnaissance {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

/// What is known of a flight that is followed piece by piece.
class Outcome {
 public:
  Outcome(std::span<const TrafficState> others, const WellClearVolume& volume, double look_ahead_s)
      : others_(others), volume_(volume), look_ahead_s_(look_ahead_s) {}

  /// The aircraft flies straight on from this state at `from_s` to `to_s`.
  void fly(const TrafficState& own, double from_s, double to_s) {
    to_s = std::min(to_s, look_ahead_s_);
    if (to_s < from_s) return;
    const double seconds = to_s - from_s;
    for (const TrafficState& other : others_) {
      const TrafficState there = straight_on(other, from_s);
      const auto violated = violation(own, there, volume_, seconds);
      if (!violated) continue;
      violated_ = true;
      const bool ends = to_s < look_ahead_s_ || violated->out_s < seconds;
      const double until_s = ends ? from_s + violated->out_s : kNever;
      clear_s_ = std::max(clear_s_, until_s);
      // What does not violate the volume is outside of it, and of what is smaller.
      const auto least = [&](const WellClearVolume& size) {
        return least_separation(own, there, size.distance_m, size.height_m, seconds);
      };
      nmac_multiple_ = std::min(nmac_multiple_, least(kNearMidAirCollision));
      volume_multiple_ = std::min(volume_multiple_, least(volume_));
    }
  }

  Manoeuvre outcome(double value, double change) const {
    return {value, change, !violated_, clear_s_, nmac_multiple_, volume_multiple_};
  }

 private:
  std::span<const TrafficState> others_;
  WellClearVolume volume_;
  double look_ahead_s_;
  bool violated_ = false;
  double clear_s_ = 0;
  double nmac_multiple_ = kNever;
  double volume_multiple_ = kNever;
};

double on_circle(double angle_rad) { return std::remainder(angle_rad, 2 * std::numbers::pi); }

/// Turns to one side step by step; what was flown so far is common to all courses that follow.
void add_courses(std::vector<Manoeuvre>& tried, const TrafficState& own, double side, int steps,
                 const Outcome& at_start, const ManoeuvreLimits& limits) {
  const double step_s = kCourseStep_rad / limits.turn_rate_rad_s;
  const double start_rad = own.course_rad();
  Outcome turning = at_start;
  TrafficState state = own;
  for (int i = 1; i <= steps; ++i) {
    // The chord of the step, flown on the course in its middle.
    const double change = side * i * kCourseStep_rad;
    const TrafficState chord = on_course(state, start_rad + change - side * kCourseStep_rad / 2);
    turning.fly(chord, (i - 1) * step_s, i * step_s);
    state = on_course(straight_on(chord, step_s), start_rad + change);
    Outcome flight = turning;
    flight.fly(state, i * step_s, limits.look_ahead_s);
    tried.push_back(flight.outcome(on_circle(start_rad + change), change));
  }
}

/// The greatest multiple of the step that is no greater than the value, and the least that is no
/// less, without the numbers that rounding puts beside a multiple.
int at_most(double value, double step) { return static_cast<int>(std::floor(value / step + 1e-9)); }
int at_least(double value, double step) { return static_cast<int>(std::ceil(value / step - 1e-9)); }

}  // namespace

std::vector<Manoeuvre> course_bands(const TrafficState& own, std::span<const TrafficState> others,
                                    const WellClearVolume& volume, const ManoeuvreLimits& limits) {
  const Outcome at_start(others, volume, limits.look_ahead_s);
  Outcome straight = at_start;
  straight.fly(own, 0, limits.look_ahead_s);
  std::vector<Manoeuvre> tried{straight.outcome(on_circle(own.course_rad()), 0)};
  add_courses(tried, own, 1, 180, at_start, limits);
  add_courses(tried, own, -1, 179, at_start, limits);
  return tried;
}

std::vector<Manoeuvre> climb_bands(const TrafficState& own, std::span<const TrafficState> others,
                                   const WellClearVolume& volume, const ManoeuvreLimits& limits) {
  std::vector<Manoeuvre> tried;
  const auto attempt = [&](double climb_m_s) {
    const double change = climb_m_s - own.up_m_s;
    const double seconds = std::abs(change) / limits.vertical_acceleration_m_s2;
    TrafficState changing = own;
    changing.up_m_s = own.up_m_s + change / 2;
    TrafficState after = straight_on(changing, seconds);
    after.up_m_s = climb_m_s;
    Outcome flight(others, volume, limits.look_ahead_s);
    flight.fly(changing, 0, seconds);
    flight.fly(after, seconds, limits.look_ahead_s);
    tried.push_back(flight.outcome(climb_m_s, change));
  };
  attempt(own.up_m_s);
  const int last = at_most(limits.greatest_climb_m_s, kClimbStep_m_s);
  for (int i = at_least(limits.least_climb_m_s, kClimbStep_m_s); i <= last; ++i) {
    attempt(i * kClimbStep_m_s);
  }
  return tried;
}

}  // namespace reconnaissance
