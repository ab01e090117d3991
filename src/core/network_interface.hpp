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

/// That the interface of that name or address is down. For 127.0.0.1, and for an empty name, which
/// means it, the loopback interface. Nothing where it is up, or not among `interfaces`.
std::optional<InterfaceObstacle> find_obstacle(const std::vector<NetworkInterface>& interfaces,
                                               const std::string& wanted);

/// For an error's text: the first such obstacle of this host and its remedy, `problem; remedy`, of
/// the interfaces that are named, or of loopback where none is. Empty where there is none, or where
/// the system does not tell.
std::string obstacle_of_this_host(const std::vector<std::string>& wanted);

}  // namespace skein
