#include "flight_simulator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "convert.hpp"
#include "flight/angles.hpp"
#include "in_system.hpp"
#include "skein/error.hpp"
#include "topics.hpp"
#include "traffic/encounter.hpp"

namespace reconnaissance {
namespace {

constexpr int kRate_hz = 50;
// Gusts of light turbulence change within some seconds.
constexpr double kGustTime_s = 5;
// Below this height vertical gusts fade.
constexpr double kGustsFrom_m = 30;
// Of the radar that looks downwards.
constexpr double kRadarHeightError_m = 0.3;

/// A wind blows from where it is named after.
Wind wind_from(double from_rad, double speed_m_s) {
  return {-speed_m_s * std::cos(from_rad), -speed_m_s * std::sin(from_rad), 0};
}

// So that what is drawn for others is not what is drawn for the own aircraft.
constexpr std::uint64_t kOtherNumbers = 1'000'003;
// Of the sensor that sees other aircraft: as of one that receives what they broadcast.
constexpr double kTrafficPlaceError_m = 15;
constexpr double kTrafficSpeedError_m_s = 0.5;

/// What a set says that has lost its wits, and one that lies: half a kilometre to the north.
Measurement garbage(Random& random) {
  Measurement measurement;
  measurement.position = {1e4 * random.normal(), 1e4 * random.normal(), 1e3 * random.normal()};
  measurement.airspeed_m_s = 100 * random.uniform();
  measurement.heading_rad = 6 * random.uniform();
  return measurement;
}

Measurement falsified(Measurement truth) {
  truth.position.north_m += 500;
  return truth;
}

Aircraft parked(const LocalFrame& frame, const RunwayText& runway, double fuel_kg) {
  Aircraft aircraft;
  aircraft.position = frame.to_local(runway.threshold);
  aircraft.heading_rad = runway.course_rad;
  aircraft.fuel_kg = fuel_kg;
  return aircraft;
}

/// As it truly moved at a tick, a little later. The wind is left out: of its climb that is nothing
/// that others would notice.
TrafficState moved_on(const LocalFrame& frame, const recon::Truth& truth, double seconds) {
  const TrafficState then{local(frame, truth.position),
                          truth.ground_speed_m_s * std::cos(truth.course_rad),
                          truth.ground_speed_m_s * std::sin(truth.course_rad),
                          truth.airspeed_m_s * std::sin(truth.climb_rad)};
  return straight_on(then, seconds);
}

}  // namespace

FlightSimulator::FlightSimulator(skein::Entity& entity, const skein::ParameterValues& values)
    : name_(entity.id()),
      runway_(parse_runway(values.get<std::string>("Runway"))),
      frame_(runway_.threshold),
      ground_(ground_of(values)),
      mean_wind_(wind_from(radians(values.find<double>("Wind from").value_or(0)),
                           values.find<double>("Wind speed").value_or(0))),
      gust_m_s_(values.find<double>("Gusts").value_or(0)),
      random_(values.find<std::uint64_t>("Seed").value_or(1)),
      failures_(parse_failures(values.find<std::string>("Sensor failures").value_or(""))),
      intruders_(parse_intruders(values.find<std::string>("Intruders").value_or(""))),
      others_(intruders_.size()),
      traffic_random_(values.find<std::uint64_t>("Seed").value_or(1) + kOtherNumbers),
      aircraft_(parked(
          frame_,
          parse_runway(
              values.find<std::string>("Own runway").value_or(values.get<std::string>("Runway"))),
          values.find<double>("Fuel").value_or(80))),
      model_(entity, parse_names(values.find<std::string>("Flight models").value_or(""))),
      health_(entity),
      commands_(entity, topic::kFlightCommand),
      sensors_out_(entity.publisher<recon::Sensors>(topic::kSensors.name, stream_qos())),
      truth_(entity.publisher<recon::Truth>(topic::kTruth.name)),
      traffic_(entity.publisher<recon::Traffic>(topic::kTraffic.name)),
      traffic_truth_(entity.publisher<recon::Traffic>(topic::kTrafficTruth.name)) {
  const auto systems = parse_names(values.find<std::string>("Systems").value_or(""));
  if (const auto expected = values.get<std::size_t>("Participants"); expected > 0)
    time_.emplace(entity, expected, values.find<double>("Speed limit").value_or(0), systems);
  else
    participant_.emplace(entity, kRate_hz, [this](Tick tick) { pass(tick); });
  for (const std::string& system :
       parse_names(values.find<std::string>("Other aircraft").value_or("")))
    companions_.emplace_back(entity, topic::kTruth, in_systems({system}));
}

void FlightSimulator::start() {
  if (participant_)
    participant_->start();
  else
    thread_ = std::jthread([this] { keep_time(ending_.get_token()); });
}

TimeKeeper& FlightSimulator::time() {
  if (!time_)
    throw skein::Unavailable(name_ +
                             " takes part in the time of another flight simulator; ask that one");
  return *time_;
}

recon::SimulationStatus FlightSimulator::status() {
  const TimeKeeper& time = this->time();
  const Pace pace = time.pace();
  return {time.run(),
          time.tick(),
          pace.paused(),
          static_cast<std::uint32_t>(time.participants()),
          time.awaited(),
          pace.limit(),
          time.ticks_per_second()};
}

void FlightSimulator::limit_speed(double times_real_time) {
  if (!(times_real_time >= 0) || std::isinf(times_real_time))
    throw recon::Refused("a speed is 0 (as fast as it can), or so many times real time");
  time().limit(times_real_time);
}

void FlightSimulator::keep_time(const std::stop_token& stop) {
  while (const auto tick = time_->await_next(stop)) {
    pass(*tick);
    time_->begin(*tick);
  }
}

void FlightSimulator::pass(Tick tick) {
  try {
    simulate(tick);
    health_.set(recon::Condition::Fine);
  } catch (const skein::Error& error) {
    health_.set(recon::Condition::Failed, error.what());
  }
  publish(tick);
  health_.tell(tick);
}

void FlightSimulator::simulate(Tick tick) {
  const std::stop_token stop = ending_.get_token();
  if (tick == 0) return model_.place(model_state(aircraft_), stop);
  const auto command = commands_.at(tick - 1);
  const Wind wind = blow();
  recon::ModelInput input;
  if (command) {
    input.bank_rad = command->bank_rad;
    input.climb_rad = command->climb_rad;
    input.airspeed_m_s = command->airspeed_m_s;
  }
  input.wind_north_m_s = wind.north_m_s;
  input.wind_east_m_s = wind.east_m_s;
  input.wind_up_m_s = wind.up_m_s;
  input.ground_m = ground_m();
  input.seconds = kTick_s;
  aircraft_ = aircraft(model_.advance(input, stop));
}

/// The mean wind, and gusts about it: a first-order Gauss-Markov process in each direction.
Wind FlightSimulator::blow() {
  const double kept = std::exp(-kTick_s / kGustTime_s);
  const double fresh = gust_m_s_ * std::sqrt(1 - kept * kept);
  gust_ = {gust_.north_m_s * kept + fresh * random_.normal(),
           gust_.east_m_s * kept + fresh * random_.normal(),
           gust_.up_m_s * kept + fresh / 2 * random_.normal()};
  // No wind blows into the ground or out of it.
  const double height_m = aircraft_.position.height_m - ground_m();
  return {mean_wind_.north_m_s + gust_.north_m_s, mean_wind_.east_m_s + gust_.east_m_s,
          gust_.up_m_s * std::min(1.0, height_m / kGustsFrom_m)};
}

void FlightSimulator::publish(Tick tick) {
  const double above_ground_m = aircraft_.position.height_m - ground_m();
  recon::Sensors sensors;
  sensors.tick = tick;
  for (std::size_t i = 0; i < sensors.sets.size(); ++i) sensors.sets[i] = measure(i, tick);
  sensors.fuel_kg = aircraft_.fuel_kg;
  sensors.radar_height_m = above_ground_m + kRadarHeightError_m * random_.normal();
  sensors.on_ground = aircraft_.on_ground;
  sensors_out_.publish(sensors);
  fly_others(tick);
  if (!is_due(topic::kTruth.period, tick)) return;
  std::uint8_t failing = 0;
  for (std::size_t i = 0; i < sensors.sets.size(); ++i)
    if (failure_of(i, tick) != SensorFailure::None) ++failing;
  truth_.publish({tick, position(frame_, aircraft_.position), above_ground_m,
                  aircraft_.airspeed_m_s,
                  course(std::atan2(aircraft_.east_m_s, aircraft_.north_m_s)),
                  std::hypot(aircraft_.north_m_s, aircraft_.east_m_s), aircraft_.heading_rad,
                  aircraft_.climb_rad, aircraft_.bank_rad, aircraft_.fuel_kg, aircraft_.on_ground,
                  aircraft_.stalled, failing, model_.name(), model_.lost()});
}

SensorFailure FlightSimulator::failure_of(std::size_t set, Tick tick) const {
  const double now_s = seconds_of(tick);
  SensorFailure failure = SensorFailure::None;
  for (const FailureText& each : failures_)
    if (each.set == set && now_s >= each.from_s && now_s < each.until_s) failure = each.kind;
  return failure;
}

recon::SensorSet FlightSimulator::measure(std::size_t set, Tick tick) {
  const auto told = failing_[set].pass(sensors_[set].measure(aircraft_, kTick_s, random_),
                                       failure_of(set, tick), kTick_s, random_, garbage, falsified);
  if (!told) return {};
  return {true,
          position(frame_, told->position),
          told->north_m_s,
          told->east_m_s,
          told->up_m_s,
          told->airspeed_m_s,
          told->heading_rad,
          told->climb_rad,
          told->bank_rad};
}

/// Who makes the time is a tick ahead of the others: of these aircraft is told where they were one
/// sample before, moved on.
std::vector<std::pair<std::uint32_t, TrafficState>> FlightSimulator::others_at(Tick tick) {
  std::vector<std::pair<std::uint32_t, TrafficState>> others;
  for (std::size_t i = 0; i < others_.size(); ++i)
    if (others_[i]) others.emplace_back(static_cast<std::uint32_t>(i + 1), *others_[i]);
  for (std::size_t i = 0; i < companions_.size(); ++i) {
    const auto truth = companions_[i].at(tick - topic::kTruth.period);
    if (!truth || truth->on_ground) continue;
    others.emplace_back(kFirstCompanion + static_cast<std::uint32_t>(i),
                        moved_on(frame_, *truth, seconds_of(tick - truth->tick)));
  }
  return others;
}

/// Others appear, and fly straight on.
void FlightSimulator::fly_others(Tick tick) {
  const TrafficState own{aircraft_.position, aircraft_.north_m_s, aircraft_.east_m_s,
                         aircraft_.up_m_s};
  for (std::size_t i = 0; i < others_.size(); ++i) {
    const IntruderText& intruder = intruders_[i];
    if (others_[i]) {
      others_[i] = straight_on(*others_[i], kTick_s);
    } else if (seconds_of(tick) >= intruder.from_s && !aircraft_.on_ground) {
      others_[i] = on_collision_course(own, own.course_rad() + intruder.direction_rad,
                                       intruder.distance_m, intruder.speed_m_s);
    }
  }
  if (!is_due(topic::kTraffic.period, tick)) return;
  recon::Traffic seen{tick, {}}, truth{tick, {}};
  for (const auto& [number, state] : others_at(tick)) {
    const auto tell = [&](recon::Traffic& traffic, double place_m, double speed_m_s) {
      TrafficState told = state;
      told.place.north_m += place_m * traffic_random_.normal();
      told.place.east_m += place_m * traffic_random_.normal();
      told.place.height_m += place_m * traffic_random_.normal();
      told.north_m_s += speed_m_s * traffic_random_.normal();
      told.east_m_s += speed_m_s * traffic_random_.normal();
      traffic.others.push_back(
          {number, position(frame_, told.place), told.north_m_s, told.east_m_s, told.up_m_s});
    };
    tell(seen, kTrafficPlaceError_m, kTrafficSpeedError_m_s);
    tell(truth, 0, 0);
  }
  traffic_.publish(seen);
  traffic_truth_.publish(truth);
}

/// Below the aircraft, above the geoid.
double FlightSimulator::ground_m() const {
  return ground_(aircraft_.position.north_m, aircraft_.position.east_m);
}

}  // namespace reconnaissance
