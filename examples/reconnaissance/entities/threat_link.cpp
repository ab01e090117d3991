#include "threat_link.hpp"

#include <utility>

#include "threat_conversion.hpp"
#include "topics.hpp"

namespace reconnaissance {

ThreatLink::End::End(const InSystem& system)
    : aircraft(system.name()),
      reports(system.entity(), topic::kLinkReports, system.qos()),
      pictures(system.publisher<recon::LinkedSites>(topic::kLinkPicture.name)) {}

ThreatLink::ThreatLink(skein::Entity& entity, const LocalFrame& frame,
                       const std::vector<std::string>& systems)
    : frame_(frame) {
  for (const std::string& each : systems) ends_.emplace_back(InSystem(entity, each));
}

void ThreatLink::relay(Tick tick) {
  for (End& end : ends_) {
    const auto told = end.reports.at(tick - topic::kLinkReports.period);
    if (!told) continue;
    std::vector<LinkTrack> tracks;
    for (const recon::LinkedSite& each : told->sites) tracks.push_back(link_track(frame_, each));
    picture_.report(end.aircraft, std::move(tracks));
  }
  recon::LinkedSites picture{tick, {}};
  for (JointPicture::Site& each : picture_.sites())
    picture.sites.push_back(
        linked_site(frame_, each.id, each.emitter, each.position, std::move(each.reporters)));
  for (End& end : ends_) end.pictures.publish(picture);
}

}  // namespace reconnaissance
