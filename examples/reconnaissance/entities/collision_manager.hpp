#pragma once

#include <cstdint>
#include <map>
#include <optional>

#include "flight.idl.hpp"
#include "geodesy/local_frame.hpp"
#include "member.hpp"
#include "skein/entity.hpp"
#include "skein/parameters.hpp"
#include "stream.hpp"
#include "threats.idl.hpp"
#include "traffic.idl.hpp"
#include "traffic/alerting.hpp"

namespace reconnaissance {

/// Keeps the aircraft well clear of others, against the route if it must, and out of weapons' reach
/// if it can. It alerts by the rules of DO-365B; its CSPs say what to fly, and its Head takes the
/// best that can be flown.
class CollisionManager {
 public:
  CollisionManager(skein::Entity& entity, const skein::ParameterValues& values);
  void start() { member_.start(); }

 private:
  void watch(Tick tick);
  recon::TrafficAlert assess(double now_s, const recon::Encounter& encounter,
                             const recon::Traffic& traffic);
  recon::Avoidance ask_avoider(const recon::Encounter& encounter);

  skein::Entity& entity_;
  std::optional<LocalFrame> frame_;  // about the first place of the aircraft
  std::map<std::uint32_t, Alert> alerts_;
  Stream<recon::FlightState> flight_;
  Stream<recon::Traffic> traffic_;
  Stream<recon::ThreatPicture> pictures_;
  skein::Publisher<recon::ResolutionAdvisory> advisories_;
  Member member_;
};

}  // namespace reconnaissance
