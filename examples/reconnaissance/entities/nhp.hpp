#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "flight.idl.hpp"
#include "geodesy/local_frame.hpp"
#include "member.hpp"
#include "mission.idl.hpp"
#include "skein/entity.hpp"
#include "skein/executor.hpp"
#include "skein/parameters.hpp"
#include "stream.hpp"

namespace reconnaissance {

/// The non-human pilot, the mission's executive: knows how everybody is, and says what the mission
/// has to do. All of its CSPs are asked, and the most severe is heard.
class Nhp {
 public:
  Nhp(skein::Entity& entity, const skein::ParameterValues& values);
  void start() { member_.start(); }

 private:
  void hear(const recon::Health& health);
  void judge(Tick tick);
  /// What is wrong with one of the crew; empty if nothing is.
  bool given_up(const std::string& name, Tick tick) const;
  std::string trouble_of(const std::string& name, Tick wanted) const;
  bool all_heard(Tick wanted) const;
  void order_flight(Tick tick, recon::MissionMode& mode);
  recon::ExecutiveDecision ask_executives(const recon::ExecutiveSituation& situation);

  skein::Entity& entity_;
  std::vector<std::string> crew_;
  std::vector<std::string> required_;
  double fuel_reserve_kg_;
  double fuel_kg_m_;                // of the way home before it is planned
  std::optional<LocalFrame> home_;  // about the first place of the aircraft
  std::vector<recon::MissingEntity> missing_;
  Tick judged_ = 0;
  std::map<std::string, recon::Health> health_;  // told before that
  std::vector<recon::Health> early_;             // told since
  bool started_ = false;

  Stream<recon::FlightState> flight_;
  skein::ManualExecutor hearing_;  // so that what is heard is heard in the mission's time
  skein::Subscription<recon::Health> healths_;
  skein::Publisher<recon::MissionMode> mode_;
  Member member_;
};

}  // namespace reconnaissance
