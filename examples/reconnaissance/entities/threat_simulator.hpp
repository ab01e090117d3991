#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "flight.idl.hpp"
#include "geodesy/hills.hpp"
#include "geodesy/local_frame.hpp"
#include "in_system.hpp"
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
/// receives of them, and what its weapons cost. Where there are several aircraft, the same sites
/// see all of them; each site looks at each aircraft as if there were no other.
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

  /// An aircraft, and what the sites do about it.
  struct Seen {
    Seen(const InSystem& system, std::vector<Site> sites, std::uint64_t seed);

    std::vector<Site> sites;
    Random random;
    Survival survival;
    double tracked_s = 0;
    Tick simulated = 0;
    Stream<recon::Truth> truth;
    skein::Publisher<recon::Intercepts> intercepts;
    skein::Publisher<recon::ThreatTruth> threat_truth;
  };

  std::vector<Site> sites_of(const std::vector<SiteText>& texts, std::uint64_t seed) const;
  void simulate(Tick tick, Seen& aircraft);
  void tell_truth(Tick tick, Seen& aircraft);

  LocalFrame frame_;
  Hills ground_;
  WarnerReceiver receiver_;
  std::deque<Seen> aircraft_;
  Member member_;
};

}  // namespace reconnaissance
