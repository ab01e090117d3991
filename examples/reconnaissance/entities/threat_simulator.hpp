#pragma once

#include "flight.idl.hpp"
#include "member.hpp"
#include "skein/entity.hpp"
#include "skein/parameters.hpp"
#include "stream.hpp"

namespace reconnaissance {

/// Will simulate the air defence: where its radars are, and what arrives of them at the aircraft.
/// As yet it takes part in the mission's time, tells its health, and listens.
class ThreatSimulator {
 public:
  ThreatSimulator(skein::Entity& entity, const skein::ParameterValues& values);
  void start() { member_.start(); }

 private:
  Stream<recon::Truth> truth_;
  Member member_;
};

}  // namespace reconnaissance
