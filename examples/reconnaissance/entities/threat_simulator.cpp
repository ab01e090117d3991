#include "threat_simulator.hpp"

#include "convert.hpp"
#include "flight/angles.hpp"
#include "threat_conversion.hpp"
#include "threats/sites.hpp"
#include "topics.hpp"

namespace reconnaissance {
namespace {

// As radars see a small aircraft: half of its length, its wings and its height.
constexpr Ellipsoid kShape{1.5, 1.0, 0.4};

}  // namespace

ThreatSimulator::ThreatSimulator(skein::Entity& entity, const skein::ParameterValues& values)
    : frame_(parse_runway(values.get<std::string>("Runway")).threshold),
      ground_(ground_of(values)),
      sites_(sites_of(parse_sites(values.get<std::string>("Sites")), frame_, ground_,
                      values.find<std::uint64_t>("Seed").value_or(1))),
      receiver_{.bearing_bias_rad = radians(values.find<double>("Bearing error").value_or(0))},
      random_(values.find<std::uint64_t>("Seed").value_or(1)),
      truth_(entity, topic::kTruth),
      intercepts_(entity.publisher<recon::Intercepts>(topic::kIntercepts.name)),
      threat_truth_(entity.publisher<recon::ThreatTruth>(topic::kThreatTruth.name)),
      member_(entity, values, [this](Tick tick) { simulate(tick); }) {}

std::vector<ThreatSimulator::Site> ThreatSimulator::sites_of(const std::vector<SiteText>& texts,
                                                             const LocalFrame& frame,
                                                             const Hills& ground,
                                                             std::uint64_t seed) {
  std::vector<Site> sites;
  for (const SiteText& text : texts) {
    const auto number = static_cast<std::uint32_t>(sites.size() + 1);
    Local foot = frame.to_local(text.place);
    foot.height_m = ground(foot.north_m, foot.east_m);
    RadarSite site = site_of_type(text.type, number, foot, text.active_from_s);
    site.silent_beyond_m = text.silent_beyond_m;
    // Another random course for each site, and in each run.
    sites.push_back({text.type, site, Radar(site, seed * 1000 + number)});
  }
  return sites;
}

void ThreatSimulator::simulate(Tick tick) {
  const auto truth = truth_.at(tick);
  recon::Intercepts received{tick, {}};
  if (truth) {
    const double now_s = seconds_of(tick), passed_s = seconds_of(tick - simulated_);
    const RadarTarget target{local(frame_, truth->position),
                             {truth->bank_rad, truth->climb_rad, truth->heading_rad},
                             kShape};
    bool tracked = false;
    for (Site& each : sites_) {
      const auto emission = each.radar.step(now_s, target, ground_);
      const RadarMode mode = each.radar.mode();
      survival_.pass(hazard_per_s(each.site, mode, target.place), passed_s);
      tracked |= each.site.zone.kills_per_s > 0 && mode > RadarMode::Search;
      if (!emission) continue;
      if (const auto heard = receive(*emission, target.place, receiver_, ground_, random_)) {
        received.intercepts.push_back(intercept(*heard, each.site.emitter));
        each.heard = true;
      }
    }
    if (tracked) tracked_s_ += passed_s;
    simulated_ = tick;
  }
  intercepts_.publish(received);
  if (is_due(topic::kThreatTruth.period, tick)) tell_truth(tick);
}

void ThreatSimulator::tell_truth(Tick tick) {
  recon::ThreatTruth told{tick, {}, tracked_s_, survival_.probability()};
  for (const Site& each : sites_) {
    told.sites.push_back({each.type, position(frame_, each.site.antenna),
                          radar_mode(each.radar.mode()), each.radar.last_detection_probability(),
                          each.heard});
  }
  threat_truth_.publish(told);
}

}  // namespace reconnaissance
