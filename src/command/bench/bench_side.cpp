#include <unistd.h>

#include <algorithm>

#include "bench.hpp"
#include "core/suggestion.hpp"
#include "dds/port/vendor_names.hpp"
#include "mission/peer/peer.hpp"
#include "mission/profile/mission_profile.hpp"
#include "skein/error.hpp"

namespace skein::command::bench {
namespace {

using profile::MissionProfile;
using profile::PeerProfile;

const PeerProfile& find_peer(const MissionProfile& mission, const std::string& name) {
  if (name.empty())
    return mission.peers.front();  // a profile without peers is refused by its reader
  if (const PeerProfile* peer = mission.find_peer(name)) return *peer;
  std::vector<std::string> known;
  for (const PeerProfile& peer : mission.peers) known.push_back(peer.name);
  throw InvalidArgument(mission.file.string() + " has no peer '" + name + "'" +
                        suggestion(name, known));
}

const PeerProfile& peer_of(const MissionProfile& mission, const BenchArguments& arguments,
                           Role role) {
  const bool calls = role == Role::Caller && !arguments.caller.empty();
  const PeerProfile& peer = find_peer(mission, calls ? arguments.caller : arguments.provider);
  if (peer.vendor != dds::kLoopback) return peer;
  throw InvalidArgument(
      profile::to_text(peer.where) + ": '" + peer.name +
      "' is on loopback, the network inside of one process, which no other process can "
      "call; choose a peer on a DDS vendor by --provider and --caller");
}

Side side_of_profile(const BenchArguments& arguments, Role role) {
  const MissionProfile mission = profile::read_mission_profile(arguments.profile);
  const PeerProfile& peer = peer_of(mission, arguments, role);
  Side side{launch::entity_options(mission, peer), {}, peer.threads.lock_memory};
  side.service.threads = std::max<std::size_t>(peer.threads.count, 1);
  side.service.scheduling = peer.threads.settings;
  return side;
}

Side side_of_options(const BenchArguments& arguments) {
  Side side;
  side.entity.vendor = dds::load_vendor(arguments.vendor);
  if (!arguments.interface.empty()) side.entity.network.interfaces = {arguments.interface};
  return side;
}

}  // namespace

Side side_of(const BenchArguments& arguments, Role role) {
  Side side =
      arguments.profile.empty() ? side_of_options(arguments) : side_of_profile(arguments, role);
  EntityOptions& entity = side.entity;
  // Beside a mission that flies, not in it.
  entity.system = "bench";
  entity.domain = arguments.domain;
  entity.name = (role == Role::Provider ? "mirror-" : "caller-") + std::to_string(getpid());
  if (!arguments.transport.empty())
    entity.shared_memory_calls = arguments.transport == "shared-memory";
  if (arguments.peer.empty()) return side;
  if (entity.network.interfaces.empty()) {
    throw InvalidArgument("--peer " + arguments.peer +
                          " is another host's address, and this side speaks on "
                          "127.0.0.1 alone; name its interface by --interface or in the profile");
  }
  entity.network.peers = {arguments.peer};
  return side;
}

std::string vendors_of(const BenchArguments& arguments) {
  if (arguments.profile.empty()) return arguments.vendor;
  const MissionProfile mission = profile::read_mission_profile(arguments.profile);
  const std::string& provider = peer_of(mission, arguments, Role::Provider).vendor;
  const std::string& caller = peer_of(mission, arguments, Role::Caller).vendor;
  return provider == caller ? provider : provider + "-" + caller;
}

}  // namespace skein::command::bench
