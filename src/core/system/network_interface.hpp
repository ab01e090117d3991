#pragma once

#include <optional>
#include <string>
#include <vector>

struct sockaddr;

namespace skein {

/// An IPv4 address in dotted form.
std::string dotted(const sockaddr& address);

/// A network interface of a host, with or without an address.
struct NetworkInterface {
  std::string name;
  std::vector<std::string> addresses;  ///< IPv4, in dotted form.
  bool up = false;
  bool running = true;  ///< Whether it has a carrier: a cable, say, with another end that is up.
  bool multicast = false;
};

/// Those of this host, in the caller's network namespace. Throws Internal where the system does not
/// tell.
std::vector<NetworkInterface> network_interfaces();

/// Why nothing can be sent, and what mends it.
struct InterfaceObstacle {
  std::string problem;
  std::string remedy;  ///< A command.
};

/// Whether an interface may be without a carrier at first: Fast DDS does not use one that is.
enum class Carrier { MayComeLater, Needed };

/// That the interface of that name or address is down, has no address (which DHCP may bring), or
/// lacks a carrier that it needs. For 127.0.0.1, and for an empty name, which means it, the
/// loopback interface. Nothing where there is no obstacle, or no such interface among `interfaces`.
std::optional<InterfaceObstacle> find_obstacle(const std::vector<NetworkInterface>& interfaces,
                                               const std::string& wanted,
                                               Carrier carrier = Carrier::MayComeLater);

/// For an error's text: the first such obstacle of this host and its remedy, `problem; remedy`, of
/// the interfaces that are named, or of loopback where none is. Empty where there is none, or where
/// the system does not tell.
std::string obstacle_of_this_host(const std::vector<std::string>& wanted,
                                  Carrier carrier = Carrier::MayComeLater);

/// Whether `wanted`, which is none of `known`, is a misspelled one of these. Otherwise it may come
/// later, as a device does that is plugged in: also if it differs in a number alone.
bool is_misspelled_interface(const std::string& wanted, const std::vector<std::string>& known);

}  // namespace skein
