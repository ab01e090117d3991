#include "threat_simulator.hpp"

#include <utility>

#include "convert.hpp"
#include "flight/angles.hpp"
#include "threat_conversion.hpp"
#include "threats/sites.hpp"
#include "topics.hpp"

namespace reconnaissance {
namespace {

// As radars see a small aircraft: half of its length, its wings and its height.
constexpr Ellipsoid kShape{1.5, 1.0, 0.4};
// So that what is drawn for one aircraft is not what is drawn for another.
constexpr std::uint64_t kNextAircraft = 1'000'003;

}  // namespace

ThreatSimulator::ThreatSimulator(skein::Entity& entity, const skein::ParameterValues& values)
    : frame_(parse_runway(values.get<std::string>("Runway")).threshold),
      ground_(ground_of(values)),
      receiver_{.bearing_bias_rad = radians(values.find<double>("Bearing error").value_or(0))},
      member_(entity, values, [this](Tick tick) {
        for (Seen& each : aircraft_) simulate(tick, each);
      }) {
  const auto sites = parse_sites(values.get<std::string>("Sites"));
  auto systems = parse_names(values.find<std::string>("Aircraft").value_or(""));
  if (systems.empty()) systems.emplace_back();
  std::uint64_t seed = values.find<std::uint64_t>("Seed").value_or(1);
  for (const std::string& system : systems) {
    aircraft_.emplace_back(InSystem(entity, system), sites_of(sites, seed), seed);
    seed += kNextAircraft;
  }
}

ThreatSimulator::Seen::Seen(const InSystem& system, std::vector<Site> sites_, std::uint64_t seed)
    : sites(std::move(sites_)),
      random(seed),
      truth(system.entity(), topic::kTruth, system.qos(stream_qos())),
      intercepts(system.publisher<recon::Intercepts>(topic::kIntercepts.name)),
      threat_truth(system.publisher<recon::ThreatTruth>(topic::kThreatTruth.name)) {}

std::vector<ThreatSimulator::Site> ThreatSimulator::sites_of(const std::vector<SiteText>& texts,
                                                             std::uint64_t seed) const {
  std::vector<Site> sites;
  for (const SiteText& text : texts) {
    const auto number = static_cast<std::uint32_t>(sites.size() + 1);
    Local foot = frame_.to_local(text.place);
    foot.height_m = ground_(foot.north_m, foot.east_m);
    RadarSite site = site_of_type(text.type, number, foot, text.active_from_s);
    site.silent_beyond_m = text.silent_beyond_m;
    // Another random course for each site, and in each run.
    sites.push_back({text.type, site, Radar(site, seed * 1000 + number)});
  }
  return sites;
}

void ThreatSimulator::simulate(Tick tick, Seen& aircraft) {
  const auto truth = aircraft.truth.at(tick);
  recon::Intercepts received{tick, {}};
  if (truth) {
    const double now_s = seconds_of(tick), passed_s = seconds_of(tick - aircraft.simulated);
    const RadarTarget target{local(frame_, truth->position),
                             {truth->bank_rad, truth->climb_rad, truth->heading_rad},
                             kShape};
    bool tracked = false;
    for (Site& each : aircraft.sites) {
      const auto emission = each.radar.step(now_s, target, ground_);
      const RadarMode mode = each.radar.mode();
      aircraft.survival.pass(hazard_per_s(each.site, mode, target.place), passed_s);
      tracked |= each.site.zone.kills_per_s > 0 && mode > RadarMode::Search;
      if (!emission) continue;
      if (const auto heard =
              receive(*emission, target.place, receiver_, ground_, aircraft.random)) {
        received.intercepts.push_back(intercept(*heard, each.site.emitter));
        each.heard = true;
      }
    }
    if (tracked) aircraft.tracked_s += passed_s;
    aircraft.simulated = tick;
  }
  aircraft.intercepts.publish(received);
  if (is_due(topic::kThreatTruth.period, tick)) tell_truth(tick, aircraft);
}

void ThreatSimulator::tell_truth(Tick tick, Seen& aircraft) {
  recon::ThreatTruth told{tick, {}, aircraft.tracked_s, aircraft.survival.probability()};
  for (const Site& each : aircraft.sites) {
    told.sites.push_back({each.type, position(frame_, each.site.antenna),
                          radar_mode(each.radar.mode()), each.radar.last_detection_probability(),
                          each.heard});
  }
  aircraft.threat_truth.publish(told);
}

}  // namespace reconnaissance
