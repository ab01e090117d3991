#include "avoider_csps.hpp"

#include <vector>

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

}  // namespace

recon::Avoidance Bands::advise(const recon::Encounter& encounter) {
  const auto alert = static_cast<AlertLevel>(static_cast<int>(encounter.alert));
  static_assert(static_cast<int>(AlertLevel::Warning) ==
                static_cast<int>(recon::TrafficAlert::Warning));
  return avoidance(avoider_.advise(traffic_state(encounter.own), others_of(encounter),
                                   encounter.route_course_rad, alert));
}

recon::Avoidance PotentialField::advise(const recon::Encounter& encounter) {
  return avoidance(avoider_.advise(traffic_state(encounter.own), others_of(encounter),
                                   encounter.route_course_rad));
}

}  // namespace reconnaissance
