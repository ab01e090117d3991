#pragma once

#include <condition_variable>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <stop_token>
#include <string>

#include "clock/ticks.hpp"
#include "geodesy/hills.hpp"
#include "geodesy/local_frame.hpp"
#include "in_system.hpp"
#include "mission.idl.hpp"
#include "mission/places.hpp"
#include "mission/verdict.hpp"
#include "mission_recorder.hpp"
#include "scoring.hpp"
#include "skein/entity.hpp"
#include "skein/introspection.idl.hpp"
#include "skein/parameters.hpp"
#include "targets.idl.hpp"
#include "threats.idl.hpp"
#include "traffic.idl.hpp"

namespace reconnaissance {

/// Begins the mission of an aircraft, watches it, and judges it by where the aircraft truly was.
class GroundStation {
 public:
  /// Places are about the runway that the profile names; the aircraft uses `runway`.
  GroundStation(const InSystem& system, const skein::ParameterValues& values,
                const RunwayText& runway);

  /// Gives the order.
  void begin();
  /// Waits for the end; why it is not the end of the flight, or an empty text.
  std::string await_end(const std::stop_token& told_to_end);

  /// As of now; `ended` as await_end() returned it.
  Verdict verdict(const std::string& ended) const;
  /// For the report, as far as it is recorded here.
  MissionRecord record() const { return recorder_.record(); }
  /// Of all aircraft, a line for each sample.
  std::string tracks() const;
  Tick last_tick() const;
  const std::string& system() const { return system_.name(); }

 private:
  template <class T>
  void hear(const std::string& topic, const skein::TopicQos& qos = {}) {
    subscriptions_.add<T>(system_, topic, qos, [this](const T& sample) { see(sample); });
  }
  std::string clock_of(Tick tick) const;
  void see(const recon::Truth& truth);
  void judge_what_is_whole();
  void see(const recon::MissionStatus& status);
  void see(const recon::MissionMode& mode);
  void see(const recon::ThreatPicture& picture);
  void see(const recon::ElementList& list);
  void see(const recon::ThreatTruth& truth);
  void see(const recon::Traffic& traffic);
  void see(const recon::ResolutionAdvisory& advisory);
  void see(const recon::FlightState& state);
  void see(const skein::introspection::Decision& decision);
  bool is_complete() const;
  bool never_begins() const;
  std::string why_time_stands();

  InSystem system_;
  recon::MissionOrder order_;
  LocalFrame frame_;
  std::optional<recon::IFlightSimulator::Proxy> simulator_;
  skein::Duration patience_;
  Hills ground_;

  mutable std::mutex mutex_;
  std::condition_variable_any changed_;
  Judge judge_;
  /// Where all aircraft were at a tick, as far as it has arrived.
  struct Moment {
    std::optional<recon::Truth> own;
    std::optional<recon::Traffic> others;
  };
  std::map<Tick, Moment> moments_;  // not judged yet
  std::optional<recon::Phase> phase_;
  std::string tracks_;  // as they are written
  std::string reason_;  // that was shown, as were
  recon::TrafficAlert alert_ = recon::TrafficAlert::NoAlert;
  bool avoiding_ = false;
  int sets_heard_ = 3;
  std::string why_limited_;
  recon::Mode mode_ = recon::Mode::Starting;
  recon::FlightOrder flight_order_ = recon::FlightOrder::FlyAsPlanned;
  std::set<std::uint32_t> threats_;  // that were shown, as were
  std::set<std::string> found_;
  std::set<std::string> collected_;
  Tick last_tick_ = -1;
  Tick last_moving_tick_ = -1;

  Recorder recorder_;
  Scoring scoring_;
  Subscriptions subscriptions_;
};

}  // namespace reconnaissance
