#pragma once

#include <string>
#include <vector>

#include "flight.idl.hpp"
#include "geodesy/hills.hpp"
#include "geodesy/local_frame.hpp"
#include "member.hpp"
#include "mission/places.hpp"
#include "skein/entity.hpp"
#include "skein/parameters.hpp"
#include "stream.hpp"
#include "threats.idl.hpp"
#include "threats/survival.hpp"
#include "threats/warner_receiver.hpp"

namespace reconnaissance {

/// Simulates the air defence: what its radars do about the aircraft, what the aircraft's warner
/// receives of them, and what its weapons cost.
class ThreatSimulator {
 public:
  ThreatSimulator(skein::Entity& entity, const skein::ParameterValues& values);
  void start() { member_.start(); }

 private:
  struct Site {
    std::string type;
    RadarSite site;
    Radar radar;
    bool heard = false;
  };

  static std::vector<Site> sites_of(const std::vector<SiteText>& texts, const LocalFrame& frame,
                                    const Hills& ground, std::uint64_t seed);
  void simulate(Tick tick);
  void tell_truth(Tick tick);

  LocalFrame frame_;
  Hills ground_;
  std::vector<Site> sites_;
  WarnerReceiver receiver_;
  Random random_;
  Survival survival_;
  double tracked_s_ = 0;
  Tick simulated_ = 0;

  Stream<recon::Truth> truth_;
  skein::Publisher<recon::Intercepts> intercepts_;
  skein::Publisher<recon::ThreatTruth> threat_truth_;
  Member member_;
};

}  // namespace reconnaissance
