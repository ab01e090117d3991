#pragma once

#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "geodesy/local_frame.hpp"
#include "in_system.hpp"
#include "mission/scores.hpp"
#include "skein/entity.hpp"
#include "skein/parameters.hpp"
#include "targets.idl.hpp"
#include "threats.idl.hpp"

namespace reconnaissance {

/// Holds what the mission says of targets and emitters against where they truly are, as far as
/// its order is to follow or to place them. Thread-safe.
class Scoring {
 public:
  Scoring(const InSystem& system, const LocalFrame& frame, const skein::ParameterValues& values);

  /// Beside those of the flight.
  std::vector<Check> checks() const;

 private:
  template <class T>
  void hear(const std::string& topic, const skein::TopicQos& qos = {}) {
    subscriptions_.add<T>(system_, topic, qos, [this](const T& sample) { see(sample); });
  }
  void see(const recon::ElementList& list);
  void see(const recon::ObjectTruths& truths);
  void see(const recon::ThreatTruth& truth);
  void see(const recon::ThreatPicture& picture);

  InSystem system_;
  LocalFrame frame_;
  double within_m_;
  double within_s_;

  mutable std::mutex mutex_;
  recon::ElementTask task_ = recon::ElementTask::TakeImages;
  PursuitScore score_;
  std::vector<Site> sites_;     // as they are,
  std::vector<Site> reported_;  // and as they are reported
  ReportDelays delays_;

  Subscriptions subscriptions_;
};

/// What is wanted of elements, as it stands in the verdict: `followed as long as was ordered`.
std::string how_collected(recon::ElementTask task);

/// How an element was collected.
std::string collected_text(const recon::Element& element);

}  // namespace reconnaissance
