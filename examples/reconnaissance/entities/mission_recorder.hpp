#pragma once

#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "flight.idl.hpp"
#include "geodesy/local_frame.hpp"
#include "in_system.hpp"
#include "mission.idl.hpp"
#include "report/record.hpp"
#include "skein/entity.hpp"
#include "skein/introspection.idl.hpp"
#include "targets.idl.hpp"
#include "threats.idl.hpp"
#include "traffic.idl.hpp"

namespace reconnaissance {

/// Records for the report what the thirteen of a system publish. Thread-safe.
class Recorder {
 public:
  Recorder(const InSystem& system, const LocalFrame& frame);

  /// All until now.
  MissionRecord record() const;

 private:
  template <class T>
  void hear(const std::string& topic, const skein::TopicQos& qos = {}) {
    subscriptions_.add<T>(system_, topic, qos, [this](const T& sample) { see(sample); });
  }
  void see(const recon::Truth& truth);
  void see(const recon::FlightState& state);
  void see(const recon::MissionStatus& status);
  void see(const recon::RouteTaken& taken);
  void see(const recon::MissionMode& mode);
  void see(const recon::ThreatPicture& picture);
  void see(const recon::ElementList& list);
  void see(const recon::Images& images);
  void see(const recon::ObjectTruths& truths);
  void see(const recon::ThreatTruth& truth);
  void see(const recon::Traffic& traffic);
  void see(const recon::ResolutionAdvisory& advisory);
  void see(const skein::introspection::Decision& decision);
  Fault* open(FaultKind kind);
  void note_site(const recon::Threat& threat, double time_s);

  struct LastTold {
    std::string choice;
    double time_s = 0;
  };
  struct Transmitter {
    Local place{};
    std::optional<double> since_s;  // Unset: not yet; 0 where that is known, or from the beginning.
  };

  InSystem system_;
  LocalFrame frame_;
  mutable std::mutex mutex_;
  MissionRecord record_;
  double now_s_ = 0;
  std::string flown_by_;
  std::uint32_t models_lost_ = 0;
  int sets_heard_ = 3;
  int sets_failing_ = 0;
  double failing_since_s_ = 0;
  std::vector<Transmitter> sites_;
  recon::TrafficAlert alert_ = recon::TrafficAlert::NoAlert;
  std::map<std::string, std::vector<double>> latencies_;  // by entity and CSP
  std::map<std::string, LastTold> last_told_;             // by entity and question

  Subscriptions subscriptions_;
};

}  // namespace reconnaissance
