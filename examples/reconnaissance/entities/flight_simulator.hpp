#pragma once

#include <array>
#include <memory>
#include <optional>
#include <thread>
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

/// Simulates the aircraft, its sensors and the wind, and makes the mission's time. In each tick it
/// lets the flight model (a CSP) pass 20 ms with the command of the tick before, and publishes what
/// the sensors measure.
class FlightSimulator : public recon::IFlightSimulator {
 public:
  FlightSimulator(skein::Entity& entity, const skein::ParameterValues& values);

  /// Begins to wait for the participants.
  void start();

  recon::SimulationStatus status() override;
  void pause() override { time_.pause(); }
  void resume() override { time_.resume(); }
  void step(std::uint32_t ticks) override { time_.step(ticks); }
  void limit_speed(double times_real_time) override;

 private:
  void simulate(const std::stop_token& stop);
  void simulate(Tick tick, const std::stop_token& stop);
  Wind blow();
  void publish(Tick tick);
  SensorFailure failure_of(std::size_t set, Tick tick) const;
  recon::SensorSet measure(std::size_t set, Tick tick);
  double ground_m() const;
  void fly_others(Tick tick);

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
  Random traffic_random_;
  Aircraft aircraft_;
  ChosenModel model_;

  HealthReport health_;
  TimeKeeper time_;
  Stream<recon::FlightCommand> commands_;
  skein::Publisher<recon::Sensors> sensors_out_;
  skein::Publisher<recon::Truth> truth_;
  skein::Publisher<recon::Traffic> traffic_;
  skein::Publisher<recon::Traffic> traffic_truth_;
  std::jthread thread_;
};

}  // namespace reconnaissance
