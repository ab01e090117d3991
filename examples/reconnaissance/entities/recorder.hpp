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
  Recorder(const InSystem& entity, const LocalFrame& frame);

  /// All until now.
  MissionRecord record() const;

 private:
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

  skein::Subscription<recon::Truth> truths_;
  skein::Subscription<recon::FlightState> states_;
  skein::Subscription<recon::MissionStatus> statuses_;
  skein::Subscription<recon::RouteTaken> routes_;
  skein::Subscription<recon::MissionMode> modes_;
  skein::Subscription<recon::ThreatPicture> pictures_;
  skein::Subscription<recon::ElementList> elements_;
  skein::Subscription<recon::Images> images_;
  skein::Subscription<recon::ObjectTruths> objects_;
  skein::Subscription<recon::ThreatTruth> threat_truths_;
  skein::Subscription<recon::Traffic> traffic_;
  skein::Subscription<recon::ResolutionAdvisory> advisories_;
  skein::Subscription<skein::introspection::Decision> decisions_;
};

}  // namespace reconnaissance
