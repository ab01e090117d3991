#pragma once

#include "dds/port/allowed_sources.hpp"
#include "dds/port/port.hpp"

/// Checks that all back ends make alike, before a vendor sees anything. All throw InvalidArgument.
namespace skein::dds {

/// RTPS maps domains to ports; beyond 232 there are none left.
inline constexpr std::uint32_t kMaxDomain = 232;

/// RTPS 9.6.1: the domain's first port, and how far behind it the first participant listens; the
/// next ones have the next pairs.
constexpr std::uint32_t domain_port(std::uint32_t domain) { return 7400 + 250 * domain; }
inline constexpr std::uint32_t kDiscoveryOffset = 10;
inline constexpr std::uint32_t kUserOffset = 11;

/// So much a socket is to hold that has not been read; the system may grant less.
inline constexpr std::uint32_t kSocketBuffer = 4u << 20;

/// So many participants of the domain can be on one host: `network.max_participants`, but no more
/// than 120, nor than have ports below 65536 (63 in domain 232).
std::uint32_t max_participants(const ParticipantOptions& options);

void check_domain(const ParticipantOptions& options);

/// Domain, interfaces and peers. An interface must exist on this host, by name or by address.
void check_options(const ParticipantOptions& options);

/// For back ends that have none.
void refuse_shared_memory(const ParticipantOptions& options, const std::string& vendor);

/// The IPv4 addresses of `network.interfaces`, in dotted form; 127.0.0.1 where none is named.
std::vector<std::string> interface_addresses(const Network& network);

/// Where such a participant looks for others, for messages: `domain 0 on 127.0.0.1`.
std::string place_of(const ParticipantOptions& options);

/// Asks the network's name servers for peers that are not addresses.
Addresses addresses_of(const Network& network);

/// Whether the network goes no further than this host's 127.0.0.1.
bool is_loopback_only(const Network& network);

/// Octets of a name of DDS: one vendor keeps no more, another one overflows a buffer far beyond.
inline constexpr std::size_t kLongestName = 255;

/// Letters, digits, `_` and `/`; begins with no digit, and not with `DCPS`.
bool is_topic_name(const std::string& name);
/// Neither holds control characters; a partition, which may be empty, no wildcards either.
bool is_type_name(const std::string& name);
bool is_partition(const std::string& name);

void check_qos(const Topic& topic, const Qos& qos);

void require_keyed(const Topic& topic);

}  // namespace skein::dds
