#include "onlooker.hpp"

#include <unistd.h>

#include <algorithm>

#include "launch/address_space.hpp"
#include "launch/launch_plan.hpp"
#include "launch/peer.hpp"
#include "profile/mission_profile.hpp"
#include "skein/entity.hpp"
#include "skein/error.hpp"

namespace skein::command {
namespace {

/// As a peer of this host speaks: one with an interface, where there is one.
dds::Network network_of(const profile::MissionProfile& mission, const std::string& host) {
  const profile::PeerProfile* chosen = nullptr;
  for (const profile::PeerProfile& peer : mission.peers) {
    if (!launch::is_here(peer.host, host)) continue;
    if (!chosen || (chosen->interface.empty() && !peer.interface.empty())) chosen = &peer;
  }
  if (!chosen) throw InvalidArgument(launch::nobody_here(mission, host));
  return launch::network_of(mission, *chosen);
}

}  // namespace

std::uint32_t Onlooker::watched_domain() const {
  if (profile.empty()) return domain;
  return static_cast<std::uint32_t>(profile::read_mission_profile(profile).domain);
}

EntityOptions Onlooker::entity_options(const std::string& name) const {
  launch::demand_address_space();
  EntityOptions options;
  options.name = "skein-" + name + "-" + std::to_string(getpid());
  options.system = "tools";
  options.vendor = dds::load_vendor(vendor);
  options.domain = watched_domain();
  if (!profile.empty()) {
    options.network = network_of(profile::read_mission_profile(profile), host);
    return options;
  }
  if (!interface.empty()) options.network.interfaces = {interface};
  options.network.peers = peers;
  options.network.multicast_discovery = multicast;
  return options;
}

}  // namespace skein::command
