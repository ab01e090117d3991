#include "collision_manager.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "avoider_csps.hpp"
#include "convert.hpp"
#include "deciding.hpp"
#include "threat_conversion.hpp"
#include "topics.hpp"

namespace reconnaissance {
namespace {

// What an avoider may ask for: more the aircraft cannot.
constexpr double kGreatestClimb_m_s = 6.3;

std::optional<std::string> cannot_be_flown(const recon::Avoidance& avoidance) {
  if (avoidance.turns && !std::isfinite(avoidance.course_rad)) return "its course is no number";
  if (avoidance.climbs && !(std::abs(avoidance.climb_m_s) <= kGreatestClimb_m_s))
    return fmt::format("it climbs at {} m/s", avoidance.climb_m_s);
  return std::nullopt;
}

}  // namespace

CollisionManager::CollisionManager(skein::Entity& entity, const skein::ParameterValues& values)
    : entity_(entity),
      flight_(entity, topic::kFlightState),
      traffic_(entity, topic::kTraffic, {}),
      pictures_(entity, topic::kThreats, skein::TopicQos::state()),
      advisories_(entity.publisher<recon::ResolutionAdvisory>(topic::kAdvisory.name,
                                                              skein::TopicQos::state())),
      member_(entity, values, [this](Tick tick) { watch(tick); }) {}

void CollisionManager::watch(Tick tick) {
  if (!is_due(topic::kAdvisory.period, tick)) return;
  const auto traffic = traffic_.at(tick);
  const auto state = flight_.at(tick);
  recon::ResolutionAdvisory advisory{tick, recon::TrafficAlert::NoAlert, {}};
  if (traffic && state && !traffic->others.empty()) {
    if (!frame_) frame_.emplace(geodetic(state->position));
    const auto motion = [&](const auto& of) {
      const Local place = local(*frame_, of.position);
      return recon::TrafficMotion{place.north_m, place.east_m, place.height_m,
                                  of.north_m_s,  of.east_m_s,  of.up_m_s};
    };
    recon::Encounter encounter{motion(*state), {}, state->route_course_rad, {}, {}};
    if (const auto picture = pictures_.at(tick))
      encounter.weapons = weapons_of(discs_of(*picture, *frame_));
    for (const recon::OtherAircraft& each : traffic->others)
      encounter.others.push_back(motion(each));
    encounter.alert = assess(seconds_of(tick), encounter, *traffic);
    advisory.alert = encounter.alert;
    advisory.avoidance = ask_avoider(encounter);
  }
  advisories_.publish(advisory);
}

recon::TrafficAlert CollisionManager::assess(double now_s, const recon::Encounter& encounter,
                                             const recon::Traffic& traffic) {
  AlertLevel highest = AlertLevel::None;
  for (std::size_t i = 0; i < encounter.others.size(); ++i) {
    const AlertLevel level = alerts_[traffic.others[i].number].assess(
        traffic_state(encounter.own), traffic_state(encounter.others[i]), now_s);
    highest = std::max(highest, level);
  }
  return static_cast<recon::TrafficAlert>(static_cast<int>(highest));
}

recon::Avoidance CollisionManager::ask_avoider(const recon::Encounter& encounter) {
  skein::Task<recon::IAvoider, recon::Avoidance> task;
  task.request = "keep clear";
  task.features = {{"others", static_cast<double>(encounter.others.size())},
                   {"alert", static_cast<double>(static_cast<int>(encounter.alert))}};
  task.run = [&](recon::IAvoider::Proxy& avoider, skein::Duration) {
    return avoider.advise(encounter);
  };
  task.evaluate.check("can be flown", cannot_be_flown);
  return decide(entity_, task).value_or(recon::Avoidance{});
}

}  // namespace reconnaissance
