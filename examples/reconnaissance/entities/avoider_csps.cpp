#include "avoider_csps.hpp"

#include <cmath>
#include <vector>

#include "threat_conversion.hpp"

namespace reconnaissance {
namespace {

std::vector<TrafficState> others_of(const recon::Encounter& encounter) {
  std::vector<TrafficState> others;
  for (const recon::TrafficMotion& each : encounter.others) others.push_back(traffic_state(each));
  return others;
}

recon::Avoidance avoidance(const ResolutionAdvisory& advisory) {
  return {advisory.course_rad.has_value(), advisory.course_rad.value_or(0),
          advisory.climb_m_s.has_value(), advisory.climb_m_s.value_or(0), advisory.recovery};
}

/// As far as it leads until another course can be advised and flown, a course costs no more than
/// that of the route.
BandsAvoider::MayFly no_deeper_into_reach(const recon::Encounter& encounter) {
  constexpr double kAhead_s = 60;
  const TrafficState own = traffic_state(encounter.own);
  const auto hazard = [own, discs = discs_of(encounter.weapons)](double course_rad) {
    const TrafficState ahead = straight_on(on_course(own, course_rad), kAhead_s);
    return hazard_of_leg(own.place, ahead.place, discs, std::hypot(own.north_m_s, own.east_m_s));
  };
  return [hazard, most = hazard(encounter.route_course_rad)](double course_rad) {
    return hazard(course_rad) <= most;
  };
}

}  // namespace

recon::Avoidance Bands::advise(const recon::Encounter& encounter) {
  const auto alert = static_cast<AlertLevel>(static_cast<int>(encounter.alert));
  static_assert(static_cast<int>(AlertLevel::Warning) ==
                static_cast<int>(recon::TrafficAlert::Warning));
  return avoidance(avoider_.advise(traffic_state(encounter.own), others_of(encounter),
                                   encounter.route_course_rad, alert,
                                   no_deeper_into_reach(encounter)));
}

recon::Avoidance PotentialField::advise(const recon::Encounter& encounter) {
  return avoidance(avoider_.advise(traffic_state(encounter.own), others_of(encounter),
                                   encounter.route_course_rad));
}

}  // namespace reconnaissance
