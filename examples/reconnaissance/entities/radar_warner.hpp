#pragma once

#include <cstdint>
#include <map>

#include "member.hpp"
#include "skein/entity.hpp"
#include "skein/parameters.hpp"
#include "stream.hpp"
#include "threats.idl.hpp"

namespace reconnaissance {

/// The radar warner: tells by received pulses which radars transmit in which mode. Its CSPs
/// classify; its Head has them vote.
class RadarWarner {
 public:
  RadarWarner(skein::Entity& entity, const skein::ParameterValues& values);
  void start() { member_.start(); }

 private:
  void warn(Tick tick);
  recon::Identification identify(const recon::PulseTrain& train, std::uint32_t number);

  skein::Entity& entity_;
  std::map<std::uint32_t, recon::PulseTrain> trains_;  // the last intercepts of each
  Stream<recon::Intercepts> intercepts_;
  skein::Publisher<recon::EmitterReports> reports_;
  Member member_;
};

}  // namespace reconnaissance
