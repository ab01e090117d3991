#include "configuration.hpp"

#include <algorithm>

#include "dds/port/options_check.hpp"

namespace skein::dds::cyclonedds {
namespace {

std::string element(const std::string& name, const std::string& value) {
  return "<" + name + ">" + value + "</" + name + ">";
}

std::string milliseconds(std::chrono::milliseconds time) {
  return std::to_string(time.count()) + " ms";
}

/// "best effort": a `min` would refuse to start on a stock host, which caps buffers at 208 KiB.
std::string socket_buffers() {
  const std::string size = " max=\"" + std::to_string(kSocketBuffer) + " B\"/>";
  return "<SocketReceiveBufferSize" + size + "<SocketSendBufferSize" + size;
}

/// On loopback nothing is gained by small packets: 1 MiB takes half the time with the largest that
/// UDP carries. On a LAN Cyclone's own sizes keep to the network's frames.
constexpr const char* kLargePackets =
    "<MaxMessageSize>65000 B</MaxMessageSize><FragmentSize>63000 B</FragmentSize>"
    "<MaxRexmitMessageSize>65000 B</MaxRexmitMessageSize>";

std::string general(const ParticipantOptions& options, const std::vector<std::string>& addresses) {
  const bool multicast = options.network.multicast_discovery;
  std::string interfaces;
  for (const std::string& address : addresses) {
    interfaces += "<NetworkInterface address=\"" + address + "\" multicast=\"" +
                  (multicast ? "true" : "false") + "\"/>";
  }
  // Never "true": data multicast aborts Debian's Fast DDS at the other end.
  return element("General", element("Interfaces", interfaces) +
                                element("AllowMulticast", multicast ? "spdp" : "false") +
                                (is_loopback_only(options.network) ? kLargePackets : ""));
}

std::string discovery(const ParticipantOptions& options,
                      const std::vector<std::string>& addresses) {
  std::string peers;
  for (const auto& list : {addresses, options.network.peers}) {
    for (const std::string& peer : list) peers += "<Peer Address=\"" + peer + "\"/>";
  }
  // One more than the highest index: Cyclone 0.10 reports the last one as taken after taking it.
  const auto highest = max_participants(options);
  return element("Discovery", element("ExternalDomainId", std::to_string(options.domain)) +
                                  element("ParticipantIndex", "auto") +
                                  element("MaxAutoParticipantIndex", std::to_string(highest)) +
                                  element("LeaseDuration", milliseconds(options.lease)) +
                                  element("Peers", peers));
}

/// GenerateKeyhash: Fast DDS cannot tell an instance's identity otherwise.
/// Watermarks: as much may wait for acknowledgment as the sockets hold; the default of 500 kB stops
/// a writer in the middle of a mebibyte. NackDelay: for so long what was asked for is not
/// asked for again. A reader that has just found its writer asks before the writer listens: with
/// 100 ms, the default, a first request waits as long in one start of three. WriterLingerDuration:
/// so long a writer's destruction waits for what has not been acknowledged. Who lives does so in a
/// heartbeat or two; with 1 s, the default, whoever leaves a provider that has died for another is
/// held up as long.
std::string internal() {
  const HeartbeatIntervals heartbeats = heartbeat_intervals(0);
  return element("Internal", element("GenerateKeyhash", "true") + socket_buffers() +
                                 element("Watermarks", element("WhcHigh", "4 MiB") +
                                                           element("WhcHighInit", "1 MiB")) +
                                 "<HeartbeatInterval max=\"" + milliseconds(heartbeats.longest) +
                                 "\">" + milliseconds(heartbeats.first) + "</HeartbeatInterval>" +
                                 "<NackDelay>10 ms</NackDelay>"
                                 "<WriterLingerDuration>100 ms</WriterLingerDuration>");
}

}  // namespace

HeartbeatIntervals heartbeat_intervals(std::size_t participants) {
  constexpr std::chrono::milliseconds kFirst{25};
  constexpr std::size_t kParticipants = 4;
  const auto first = kFirst * std::max(participants, kParticipants) / kParticipants;
  return {first, 8 * first};
}

std::string configuration(const ParticipantOptions& options) {
  const auto addresses = interface_addresses(options.network);
  return element("CycloneDDS", "<Domain Id=\"any\">" + general(options, addresses) +
                                   discovery(options, addresses) + internal() + "</Domain>");
}

}  // namespace skein::dds::cyclonedds
