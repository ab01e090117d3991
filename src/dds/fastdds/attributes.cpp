#include "attributes.hpp"

#include <algorithm>
#include <random>

#include "announced_representation.hpp"
#include "core/system/host.hpp"
#include "dds/port/options_check.hpp"
#include "dds/port/type_version.hpp"
#include "fast_shared_memory.hpp"

namespace skein::dds::fastdds {
namespace {

using namespace std::chrono_literals;

constexpr auto kAnnouncementPeriod = 250ms;
/// While a sample is not acknowledged. With 3 s, the default, a late joiner on Cyclone waits that
/// long for the past.
constexpr auto kPastHeartbeat = 100ms;
/// Of writers without a past, calls' among them: Cyclone's reader of a large sample asks for what
/// it lacks of it when a heartbeat comes, not before.
constexpr auto kVolatileHeartbeat = 25ms;
constexpr auto kSuppression = 10ms;

Duration_t duration(std::chrono::milliseconds time) {
  return {static_cast<std::int32_t>(time.count() / 1000),
          static_cast<std::uint32_t>(time.count() % 1000 * 1'000'000)};
}

rtps::Locator_t locator(const std::string& address, std::uint32_t port) {
  rtps::Locator_t result;
  result.kind = LOCATOR_KIND_UDPv4;
  rtps::IPLocator::setIPv4(result, address);
  result.port = port;
  return result;
}

/// An announcement may be lost: it is repeated before the lease is half over, and often enough for
/// a peer that was not listening yet.
std::chrono::milliseconds announcement_period(std::chrono::milliseconds lease) {
  return std::min<std::chrono::milliseconds>(kAnnouncementPeriod, lease * 2 / 5);
}

template <class EndpointQos>
void fill_common(EndpointQos& endpoint, const Qos& qos) {
  endpoint.m_reliability.kind =
      qos.reliable ? policies::RELIABLE_RELIABILITY_QOS : policies::BEST_EFFORT_RELIABILITY_QOS;
  endpoint.m_durability.kind = qos.transient_local ? policies::TRANSIENT_LOCAL_DURABILITY_QOS
                                                   : policies::VOLATILE_DURABILITY_QOS;
  for (const std::string& name : qos.partitions) endpoint.m_partition.push_back(name.c_str());
  if (qos.liveliness_lease) {
    endpoint.m_liveliness.lease_duration = duration(*qos.liveliness_lease);
    // Never by Fast DDS itself (liveliness.hpp).
    endpoint.m_liveliness.announcement_period = kInfinite;
  }
  if (qos.deadline) endpoint.m_deadline.period = duration(*qos.deadline);
  if (qos.exclusive) endpoint.m_ownership.kind = policies::EXCLUSIVE_OWNERSHIP_QOS;
  endpoint.data_sharing.off();
  endpoint.m_userData.data_vec(to_user_data(qos.type));
}

Qos announced_qos(const AnnouncedEndpoint& endpoint) {
  const auto period = [](const Duration_t& time) {
    const auto finite = from_duration(time);
    return finite ? std::optional(std::chrono::duration_cast<std::chrono::milliseconds>(*finite))
                  : std::nullopt;
  };
  Qos qos;
  qos.reliable = endpoint.reliability.kind == policies::RELIABLE_RELIABILITY_QOS;
  qos.transient_local = endpoint.durability.kind != policies::VOLATILE_DURABILITY_QOS;
  qos.deadline = period(endpoint.deadline.period);
  qos.liveliness_lease = period(endpoint.liveliness.lease_duration);
  qos.exclusive = endpoint.ownership.kind == policies::EXCLUSIVE_OWNERSHIP_QOS;
  const auto& listed = endpoint.representation.m_value;
  const bool xcdr2 = std::ranges::count(listed, policies::XCDR2_DATA_REPRESENTATION) > 0;
  const bool xcdr1 =
      listed.empty() || std::ranges::count(listed, policies::XCDR_DATA_REPRESENTATION) > 0;
  qos.representation = xcdr1 && xcdr2 ? DataRepresentation::Any
                       : xcdr2        ? DataRepresentation::Xcdr2
                                      : DataRepresentation::Xcdr1;
  qos.type = from_user_data(endpoint.user_data.data_vec());
  for (const auto& partition : endpoint.partition.getNames()) qos.partitions.push_back(partition);
  return qos;
}

void fill_endpoint(rtps::EndpointAttributes& endpoint, const Topic& topic, const Qos& qos) {
  endpoint.topicKind = topic.keyed ? rtps::WITH_KEY : rtps::NO_KEY;
  endpoint.reliabilityKind = qos.reliable ? rtps::RELIABLE : rtps::BEST_EFFORT;
  endpoint.durabilityKind = qos.transient_local ? rtps::TRANSIENT_LOCAL : rtps::VOLATILE;
  policies::DataSharingQosPolicy off;
  off.off();
  endpoint.set_data_sharing_configuration(off);
}

// Here a port is a name in /dev/shm and no more. One that was a killed process's would be made
// anew, while others would go on writing to the old one, in which nobody reads.
std::uint32_t unused_port() {
  constexpr std::uint32_t kBeyondUdp = 1u << 16;
  std::random_device random;
  return kBeyondUdp + random() / 2;
}

// Beside UDP, and for samples alone: discovery goes by UDP, and so do the packets that `transport`
// repairs, or takes for liveliness. To a reader on this host that has such a locator, Fast DDS then
// writes by nothing else.
void add_shared_memory(rtps::RTPSParticipantAttributes& attributes) {
  const auto memory = std::make_shared<transports::SharedMemTransportDescriptor>();
  // Room for the fragments of some mebibytes; the default's half a mebibyte loses them.
  memory->segment_size(kSegment);
  // The locator holds this host's number, which Fast DDS keeps to itself.
  const std::unique_ptr<transports::TransportInterface> transport(memory->create_transport());
  transport->getDefaultUnicastLocators(attributes.defaultUnicastLocatorList, unused_port());
  attributes.userTransports.push_back(memory);
}

}  // namespace

std::shared_ptr<StartupTransportDescriptor> make_transport(const ParticipantOptions& options) {
  const Network& network = options.network;
  auto udp = std::make_shared<transports::UDPv4TransportDescriptor>();
  udp->interfaceWhiteList = interface_addresses(network);
  // The kernel gives what it may; with 208 KiB a mebibyte takes three times as long.
  udp->sendBufferSize = StartupTransportDescriptor::kSendBuffer;
  udp->receiveBufferSize = kSocketBuffer;
  udp->maxInitialPeersRange = max_participants(options);
  return std::make_shared<StartupTransportDescriptor>(
      std::move(udp), options.lease, announcement_period(options.lease), addresses_of(network));
}

rtps::RTPSParticipantAttributes participant_attributes(
    const ParticipantOptions& options,
    const std::shared_ptr<StartupTransportDescriptor>& transport) {
  rtps::RTPSParticipantAttributes attributes;
  attributes.setName(options.name.c_str());
  leave_out_services(attributes);
  attributes.useBuiltinTransports = false;  // they listen everywhere, and bring shared memory
  attributes.userTransports.push_back(transport);

  auto& builtin = attributes.builtin;
  auto& discovery = builtin.discovery_config;
  discovery.leaseDuration = duration(options.lease);
  discovery.leaseDuration_announcementperiod = duration(announcement_period(options.lease));
  discovery.initial_announcements = {5, duration(10ms)};
  builtin.avoid_builtin_multicast = true;
  builtin.mutation_tries = max_participants(options) - 1;

  // From these and a participant's number in the process's life Fast DDS works out ports that are
  // not used, as every locator states its own, and ends the process where there are none so high.
  attributes.port.portBase = 0;
  attributes.port.domainIDGain = 0;

  // Ports are taken from the domain's first on: left to itself, Fast DDS counts participants over
  // all domains of the process and soon listens where no peer looks.
  const std::uint32_t base = domain_port(options.domain);
  for (const std::string& address : interface_addresses(options.network)) {
    builtin.metatrafficUnicastLocatorList.push_back(locator(address, base + kDiscoveryOffset));
    attributes.defaultUnicastLocatorList.push_back(locator(address, base + kUserOffset));
    builtin.initialPeersList.push_back(locator(address, 0));
  }
  for (const std::string& peer : options.network.peers) {
    for (const std::string& address : host_addresses(peer)) {
      builtin.initialPeersList.push_back(locator(address, 0));
    }
  }
  if (options.network.shared_memory) add_shared_memory(attributes);
  if (options.network.multicast_discovery) {
    const auto group = locator("239.255.0.1", base);
    builtin.metatrafficMulticastLocatorList.push_back(group);
    builtin.initialPeersList.push_back(group);
  }
  return attributes;
}

rtps::WriterAttributes writer_attributes(const Topic& topic, const Qos& qos) {
  rtps::WriterAttributes attributes;
  fill_endpoint(attributes.endpoint, topic, qos);
  attributes.times.*kHeartbeatPeriod =
      duration(qos.transient_local ? kPastHeartbeat : kVolatileHeartbeat);
  // Cyclone ignores a volatile writer until its first heartbeat.
  attributes.times.*kInitialHeartbeatDelay = duration(0ms);
  attributes.times.*kNackResponseDelay = duration(0ms);
  // A timer that each write starts. With 0, the default, it goes off at once: Fast DDS's timer
  // thread wakes two or three times a write, in the caller's way. For so long a lost sample is not
  // asked for again.
  attributes.times.*kNackSuppression = duration(kSuppression);
  attributes.mode =
      rtps::SYNCHRONOUS_WRITER;  // large samples too are sent, in fragments, by write()
  if (qos.liveliness_lease) {
    attributes.liveliness_lease_duration = duration(*qos.liveliness_lease);
  }
  return attributes;
}

rtps::ReaderAttributes reader_attributes(const Topic& topic, const Qos& qos) {
  rtps::ReaderAttributes attributes;
  fill_endpoint(attributes.endpoint, topic, qos);
  attributes.times.*kInitialAckNackDelay = duration(10ms);
  // A Cyclone writer with a mebibyte unacknowledged stops until it is: 5 ms, the default, each
  // time.
  attributes.times.*kHeartbeatResponseDelay = duration(0ms);
  return attributes;
}

rtps::HistoryAttributes history_attributes(std::uint32_t max_samples) {
  // Not a dynamic policy: with one, a disposal of 0 bytes blocks a reader for ever.
  constexpr std::uint32_t kFirstPayload = 512;
  return {rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE, kFirstPayload, 1,
          static_cast<std::int32_t>(max_samples)};
}

WriterQos writer_qos(const Qos& qos) {
  WriterQos result;
  fill_common(result, qos);
  if (qos.lifespan) result.m_lifespan.duration = duration(*qos.lifespan);
  result.m_ownershipStrength.value = static_cast<std::uint32_t>(qos.strength);
  set_representation(result, qos.representation);
  return result;
}

ReaderQos reader_qos(const Qos& qos) {
  ReaderQos result;
  fill_common(result, qos);
  set_representation(result, qos.representation);
  return result;
}

Endpoint to_endpoint(Side side, const AnnouncedEndpoint& endpoint) {
  return {side, endpoint.topic, endpoint.type, announced_qos(endpoint)};
}

std::optional<std::chrono::nanoseconds> from_duration(const Duration_t& duration) {
  if (duration == kInfinite) return std::nullopt;
  return std::chrono::nanoseconds(duration.to_ns());
}

}  // namespace skein::dds::fastdds
