#include "sensors.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "angles.hpp"

namespace reconnaissance {
namespace {

template <class Member>
std::array<std::optional<double>, 3> each(
    const std::array<std::optional<Measurement>, 3>& measurements, const Member& member) {
  std::array<std::optional<double>, 3> values;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (measurements[i]) values[i] = member(*measurements[i]);
  return values;
}

// Comparisons that are false for what is no number: a set that measures none disagrees.
bool agrees(const VotingLimits& limits, const Measurement& one, const Measurement& other) {
  const auto near = [](double a, double b, double limit) { return std::abs(a - b) <= limit; };
  const auto near_angle = [&](double a, double b) {
    return std::abs(wrapped(a - b)) <= limits.angle_rad;
  };
  return near(one.position.north_m, other.position.north_m, limits.level_m) &&
         near(one.position.east_m, other.position.east_m, limits.level_m) &&
         near(one.position.height_m, other.position.height_m, limits.height_m) &&
         near(one.north_m_s, other.north_m_s, limits.velocity_m_s) &&
         near(one.east_m_s, other.east_m_s, limits.velocity_m_s) &&
         near(one.up_m_s, other.up_m_s, limits.velocity_m_s) &&
         near(one.airspeed_m_s, other.airspeed_m_s, limits.airspeed_m_s) &&
         near_angle(one.heading_rad, other.heading_rad) &&
         near_angle(one.climb_rad, other.climb_rad) && near_angle(one.bank_rad, other.bank_rad);
}

}  // namespace

Measurement SensorModel::measure(const Aircraft& aircraft, double seconds, Random& random) {
  const auto with = [&](double value, double deviation) {
    return value + deviation * random.normal();
  };
  const double kept = settled_ ? std::exp(-seconds / noise_.wander_time_s) : 0;
  const double fresh = std::sqrt(1 - kept * kept);
  settled_ = true;
  error_.north_m = with(error_.north_m * kept, fresh * noise_.level_m);
  error_.east_m = with(error_.east_m * kept, fresh * noise_.level_m);
  error_.height_m = with(error_.height_m * kept, fresh * noise_.height_m);
  Measurement measured;
  measured.position.north_m = aircraft.position.north_m + error_.north_m;
  measured.position.east_m = aircraft.position.east_m + error_.east_m;
  measured.position.height_m = aircraft.position.height_m + error_.height_m;
  measured.north_m_s = with(aircraft.north_m_s, noise_.velocity_m_s);
  measured.east_m_s = with(aircraft.east_m_s, noise_.velocity_m_s);
  measured.up_m_s = with(aircraft.up_m_s, noise_.velocity_m_s);
  measured.airspeed_m_s = with(aircraft.airspeed_m_s, noise_.airspeed_m_s);
  measured.heading_rad = course(with(aircraft.heading_rad, noise_.angle_rad));
  measured.climb_rad = with(aircraft.climb_rad, noise_.angle_rad);
  measured.bank_rad = with(aircraft.bank_rad, noise_.angle_rad);
  return measured;
}

std::optional<double> mid_value(const std::array<std::optional<double>, 3>& values) {
  std::vector<double> measured;
  for (const auto& value : values)
    if (value && !std::isnan(*value)) measured.push_back(*value);
  if (measured.empty()) return std::nullopt;
  std::sort(measured.begin(), measured.end());
  if (measured.size() == 2) return (measured[0] + measured[1]) / 2;
  return measured[measured.size() / 2];
}

std::optional<double> mid_angle_rad(const std::array<std::optional<double>, 3>& angles) {
  std::optional<double> origin;
  std::array<std::optional<double>, 3> from_origin;
  for (std::size_t i = 0; i < angles.size(); ++i) {
    if (!angles[i] || std::isnan(*angles[i])) continue;
    if (!origin) origin = angles[i];
    from_origin[i] = wrapped(*angles[i] - *origin);
  }
  const auto middle = mid_value(from_origin);
  return middle ? std::optional(course(*origin + *middle)) : std::nullopt;
}

std::optional<Measurement> mid_measurement(
    const std::array<std::optional<Measurement>, 3>& measurements) {
  const auto middle = [&](const auto& member) { return mid_value(each(measurements, member)); };
  const auto angle = [&](double Measurement::*member) {
    return mid_angle_rad(each(measurements, [&](const Measurement& m) { return m.*member; }));
  };
  const auto north = middle([](const Measurement& m) { return m.position.north_m; });
  const auto east = middle([](const Measurement& m) { return m.position.east_m; });
  const auto height = middle([](const Measurement& m) { return m.position.height_m; });
  const auto heading = angle(&Measurement::heading_rad);
  const auto climb = angle(&Measurement::climb_rad), bank = angle(&Measurement::bank_rad);
  const auto to_north = middle([](const Measurement& m) { return m.north_m_s; });
  const auto to_east = middle([](const Measurement& m) { return m.east_m_s; });
  const auto up = middle([](const Measurement& m) { return m.up_m_s; });
  const auto airspeed = middle([](const Measurement& m) { return m.airspeed_m_s; });
  for (const auto& value :
       {north, east, height, heading, climb, bank, to_north, to_east, up, airspeed})
    if (!value) return std::nullopt;
  return Measurement{{*north, *east, *height}, *to_north,     *to_east, *up, *airspeed, *heading,
                     wrapped(*climb),          wrapped(*bank)};
}

std::optional<Measurement> Voter::vote(
    const std::array<std::optional<Measurement>, 3>& measurements, double seconds) {
  auto heard = measurements;
  for (std::size_t i = 0; i < sets_.size(); ++i)
    if (sets_[i].out) heard[i].reset();
  // If no set is heard, all that measure are believed alike.
  const auto before = mid_measurement(mid_measurement(heard) ? heard : measurements);
  for (std::size_t i = 0; i < sets_.size(); ++i) {
    Set& set = sets_[i];
    const bool fit = before && measurements[i] && agrees(limits_, *measurements[i], *before);
    set.for_s = fit == set.out ? set.for_s + seconds : 0;
    if (set.for_s < (set.out ? limits_.back_after_s : limits_.out_after_s)) continue;
    set = {.out = !set.out, .for_s = 0};
    heard[i] = set.out ? std::nullopt : measurements[i];
  }
  const auto voted = mid_measurement(heard);
  return voted ? voted : before;
}

}  // namespace reconnaissance
