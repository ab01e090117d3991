#include "options_check.hpp"

#include <arpa/inet.h>

#include <algorithm>
#include <cctype>

#include "core/printable.hpp"
#include "core/suggestion.hpp"
#include "core/system/host.hpp"
#include "core/system/network_interface.hpp"
#include "skein/error.hpp"
#include "vendor_names.hpp"

namespace skein::dds {
namespace {

constexpr const char* kLoopbackAddress = "127.0.0.1";
constexpr const char* kNoText = "has more than 255 octets, or control characters";

bool is_text(const std::string& name) {
  return name.size() <= kLongestName &&
         std::ranges::none_of(name, [](unsigned char c) { return c < 0x20 || c == 0x7f; });
}

// What is longer overflows a clock, or what DDS sends: 2^31 s.
constexpr std::chrono::milliseconds kLongest = std::chrono::hours(50 * 365 * 24);

std::string too_long(const std::string& what, std::chrono::milliseconds time) {
  return what + " of " + std::to_string(time.count()) + " ms is longer than 50 years; write less";
}

std::string address_of(const std::string& wanted, const std::vector<HostInterface>& host) {
  for (const HostInterface& interface : host) {
    if (wanted == interface.name || wanted == interface.address) return interface.address;
  }
  // All of 127.0.0.0/8 is this host, whether or not an interface lists it.
  in_addr address{};
  if (inet_pton(AF_INET, wanted.c_str(), &address) == 1 && (ntohl(address.s_addr) >> 24) == 127) {
    return wanted;
  }
  if (const std::string obstacle = obstacle_of_this_host({wanted}); !obstacle.empty())
    throw Unavailable(obstacle);
  std::vector<std::string> known;
  for (const HostInterface& interface : host) known.push_back(interface.name);
  const std::string text = "this host has no interface '" + wanted + "' with an IPv4 address" +
                           suggestion(wanted, known) + "; it has " + to_text(host);
  if (is_misspelled_interface(wanted, known)) throw InvalidArgument(text);
  throw Unavailable(text);
}

bool is_host_name(const std::string& text) {
  return !text.empty() && std::ranges::all_of(text, [](unsigned char c) {
    return std::isalnum(c) || c == '.' || c == '-' || c == '_';
  });
}

}  // namespace

std::uint32_t max_participants(const ParticipantOptions& options) {
  constexpr std::uint32_t kMost = 120;
  constexpr std::uint32_t kHighestPort = 65535;
  const std::uint32_t first = domain_port(options.domain) + kDiscoveryOffset;
  const std::uint32_t with_ports = (kHighestPort - first + 1) / 2;
  return std::clamp(options.network.max_participants, 1u, std::min(kMost, with_ports));
}

void check_domain(const ParticipantOptions& options) {
  if (options.domain <= kMaxDomain) return;
  throw InvalidArgument("domain " + std::to_string(options.domain) + " is out of range: 0 to " +
                        std::to_string(kMaxDomain));
}

void check_options(const ParticipantOptions& options) {
  check_domain(options);
  const auto addresses = interface_addresses(options.network);
  static_cast<void>(AllowedSources(options.network.allowed_sources));
  for (const std::string& peer : options.network.peers) {
    if (!is_host_name(peer)) {
      throw InvalidArgument("peer '" + peer + "' is neither an address nor a host's name");
    }
  }
  const Network& network = options.network;
  if (network.interfaces.empty() && (network.multicast_discovery || !network.peers.empty())) {
    throw InvalidArgument(
        "other hosts are to be found, by network." +
        std::string(network.multicast_discovery ? "multicast_discovery" : "peers") +
        ", but network.interfaces is empty, which is this host's 127.0.0.1 alone; name the "
        "interface that leads to them. This host has " +
        to_text(interfaces_of_this_host()));
  }
  if (options.lease < std::chrono::milliseconds(20)) {
    throw InvalidArgument("a participant's lease of " + std::to_string(options.lease.count()) +
                          " ms is too short: 20 ms at least");
  }
  if (options.lease > kLongest)
    throw InvalidArgument(too_long("a participant's lease", options.lease));
}

void refuse_shared_memory(const ParticipantOptions& options, const std::string& vendor) {
  if (!options.network.shared_memory) return;
  throw InvalidArgument(vendor + " has no shared memory here; leave it off, or use the vendor '" +
                        alternatives(shared_memory_vendors()) + "'");
}

std::vector<std::string> interface_addresses(const Network& network) {
  if (network.interfaces.empty()) return {kLoopbackAddress};
  const auto host = interfaces_of_this_host();
  std::vector<std::string> addresses;
  for (const std::string& wanted : network.interfaces)
    addresses.push_back(address_of(wanted, host));
  return addresses;
}

std::string place_of(const ParticipantOptions& options) {
  std::string place = "domain " + std::to_string(options.domain);
  std::string_view separator = " on ";
  for (const std::string& address : interface_addresses(options.network)) {
    place.append(separator).append(address);
    separator = " and ";
  }
  return place;
}

Addresses addresses_of(const Network& network) {
  Addresses addresses{AllowedSources(network.allowed_sources), {}, {}};
  for (const std::string& address : interface_addresses(network)) {
    if (!network.allowed_sources.empty()) addresses.sources.add(address);
    addresses.own.add(address);
  }
  addresses.named = addresses.own;
  for (const std::string& source : network.allowed_sources) addresses.named.add(source);
  for (const std::string& peer : network.peers) {
    for (const std::string& address : host_addresses(peer)) addresses.named.add(address);
  }
  return addresses;
}

bool is_loopback_only(const Network& network) {
  return std::ranges::all_of(interface_addresses(network), [](const std::string& address) {
    return address.starts_with("127.");
  });
}

// What Cyclone takes; other vendors take more.
bool is_topic_name(const std::string& name) {
  return !name.empty() && name.size() <= kLongestName &&
         !std::isdigit(static_cast<unsigned char>(name[0])) && !name.starts_with("DCPS") &&
         std::ranges::all_of(
             name, [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '/'; });
}

bool is_type_name(const std::string& name) { return !name.empty() && is_text(name); }

bool is_partition(const std::string& name) {
  return is_text(name) && name.find_first_of("*?[]") == std::string::npos;
}

void check_qos(const Topic& topic, const Qos& qos) {
  const auto refuse = [&](const std::string& why) {
    throw InvalidArgument("topic '" + printable(topic.name) + "': " + why);
  };
  if (!is_topic_name(topic.name)) {
    refuse(
        "a topic's name has letters, digits, '_' and '/', 255 at most, and does not begin with a "
        "digit or 'DCPS'");
  }
  if (topic.type_name.empty()) refuse("a topic needs a type's name");
  if (!is_type_name(topic.type_name)) {
    refuse("its type's name, '" + printable(topic.type_name) + "', " + kNoText);
  }
  if (qos.history_depth && *qos.history_depth == 0) refuse("a history depth of 0 keeps nothing");
  if (qos.max_blocking.count() < 0) refuse("max_blocking is negative");
  for (const auto& time :
       {std::optional(qos.max_blocking), qos.liveliness_lease, qos.deadline, qos.lifespan}) {
    if (time > kLongest) refuse(too_long("a time", *time));
  }
  if (qos.liveliness_lease && qos.liveliness_lease->count() <= 0) {
    refuse("a liveliness lease must be longer than 0");
  }
  if (qos.deadline && qos.deadline->count() <= 0) refuse("a deadline must be longer than 0");
  if (qos.lifespan && qos.lifespan->count() <= 0) refuse("a lifespan must be longer than 0");
  if (qos.strength < 0) refuse("an ownership strength must not be negative");
  if (qos.strength > 0 && !qos.exclusive) {
    refuse("a strength means nothing without exclusive ownership; set `exclusive` too");
  }
  for (const std::string& partition : qos.partitions) {
    if (is_partition(partition)) continue;
    refuse("partition '" + printable(partition) + "' " +
           (is_text(partition) ? "has a wildcard; vendors differ in what they match" : kNoText));
  }
}

void require_keyed(const Topic& topic) {
  if (topic.keyed) return;
  throw InvalidArgument("topic '" + topic.name + "' has no keys, so nothing of it can be disposed");
}

}  // namespace skein::dds
