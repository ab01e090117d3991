#pragma once

#include <mutex>
#include <string>
#include <vector>

#include "mission.idl.hpp"
#include "mission_participant.hpp"
#include "skein/parameters.hpp"

namespace reconnaissance {

/// Tells once a second of the mission how an entity is. Thread-safe.
class HealthReport {
 public:
  /// In these systems, or the entity's own if there are none.
  explicit HealthReport(skein::Entity& entity, const std::vector<std::string>& systems = {});

  /// What is told from now on.
  void set(recon::Condition condition, const std::string& reason = "");

  /// Tells it in ticks at which it is due; `failure`, if it is not empty, comes first.
  void tell(Tick tick, const std::string& failure = "");

 private:
  std::mutex mutex_;
  recon::Health health_;
  skein::Publisher<recon::Health> publisher_;
};

/// One of the thirteen: takes part in the mission's time at the rate of its profile (the parameter
/// `Rate`), and tells how it is.
class Member {
 public:
  /// `work` is done in each tick at which the member is due, before its health is told; in these
  /// systems, or the entity's own if there are none.
  Member(skein::Entity& entity, const skein::ParameterValues& values, Participant::Work work = {},
         const std::vector<std::string>& systems = {});

  void start() { participant_.start(); }
  Participant& time() { return participant_; }
  HealthReport& health() { return health_; }

 private:
  HealthReport health_;
  Participant participant_;
};

}  // namespace reconnaissance
