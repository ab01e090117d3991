#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "chosen_model.hpp"
#include "flight.idl.hpp"
#include "flight/sensors.hpp"
#include "geodesy/hills.hpp"
#include "geodesy/local_frame.hpp"
#include "member.hpp"
#include "mission/places.hpp"
#include "skein/entity.hpp"
#include "skein/parameters.hpp"
#include "stream.hpp"
#include "time_keeper.hpp"
#include "traffic.idl.hpp"
#include "traffic/well_clear.hpp"

namespace reconnaissance {

/// Simulates the aircraft, its sensors and the wind, and makes the mission's time, unless it takes
/// part in that of another one (0 participants). In each tick it lets the flight model (a CSP) pass
/// 20 ms with the command of the tick before, and publishes what the sensors measure.
class FlightSimulator : public recon::IFlightSimulator {
 public:
  FlightSimulator(skein::Entity& entity, const skein::ParameterValues& values);
  ~FlightSimulator() { ending_.request_stop(); }

  /// Begins to wait for the participants, or to take part.
  void start();

  recon::SimulationStatus status() override;
  void pause() override { time().pause(); }
  void resume() override { time().resume(); }
  void step(std::uint32_t ticks) override { time().step(ticks); }
  void limit_speed(double times_real_time) override;

 private:
  TimeKeeper& time();
  void keep_time(const std::stop_token& stop);
  void pass(Tick tick);
  void simulate(Tick tick);
  Wind blow();
  void publish(Tick tick);
  SensorFailure failure_of(std::size_t set, Tick tick) const;
  recon::SensorSet measure(std::size_t set, Tick tick);
  double ground_m() const;
  void fly_others(Tick tick);
  std::vector<std::pair<std::uint32_t, TrafficState>> others_at(Tick tick);

  const std::string name_;
  RunwayText runway_;
  LocalFrame frame_;
  Hills ground_;
  Wind mean_wind_;
  double gust_m_s_;
  Wind gust_{};
  Random random_;
  std::array<SensorModel, 3> sensors_;
  std::array<FailingSensor<Measurement>, 3> failing_;
  std::vector<FailureText> failures_;
  std::vector<IntruderText> intruders_;
  std::vector<std::optional<TrafficState>> others_;  // of each intruder, once it is there
  std::deque<Stream<recon::Truth>> companions_;      // other aircraft of the mission
  Random traffic_random_;
  Aircraft aircraft_;
  ChosenModel model_;

  HealthReport health_;
  std::optional<TimeKeeper> time_;
  Stream<recon::FlightCommand> commands_;
  skein::Publisher<recon::Sensors> sensors_out_;
  skein::Publisher<recon::Truth> truth_;
  skein::Publisher<recon::Traffic> traffic_;
  skein::Publisher<recon::Traffic> traffic_truth_;
  std::stop_source ending_;
  std::optional<Participant> participant_;  // where another simulator makes the time
  std::jthread thread_;
};

}  // namespace reconnaissance
