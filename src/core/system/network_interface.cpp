#include "core/system/network_interface.hpp"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>

#include <algorithm>
#include <memory>

#include "core/suggestion.hpp"
#include "skein/error.hpp"

namespace skein {
namespace {

NetworkInterface& of_name(std::vector<NetworkInterface>& interfaces, const std::string& name) {
  const auto found = std::ranges::find(interfaces, name, &NetworkInterface::name);
  if (found != interfaces.end()) return *found;
  interfaces.push_back({.name = name, .addresses = {}});
  return interfaces.back();
}

/// With each number as one `#`.
std::string without_numbers(const std::string& name) {
  std::string text;
  for (const char c : name) {
    const bool digit = c >= '0' && c <= '9';
    if (!digit || !text.ends_with('#')) text += digit ? '#' : c;
  }
  return text;
}

}  // namespace

std::string dotted(const sockaddr& address) {
  char text[INET_ADDRSTRLEN] = "";
  inet_ntop(AF_INET, &reinterpret_cast<const sockaddr_in&>(address).sin_addr, text, sizeof text);
  return text;
}

std::vector<NetworkInterface> network_interfaces() {
  ifaddrs* first = nullptr;
  if (getifaddrs(&first) != 0) throw Internal("the system does not tell its network interfaces");
  const std::unique_ptr<ifaddrs, decltype(&freeifaddrs)> all(first, freeifaddrs);
  std::vector<NetworkInterface> interfaces;
  for (const ifaddrs* one = first; one; one = one->ifa_next) {
    NetworkInterface& interface = of_name(interfaces, one->ifa_name);
    interface.up = (one->ifa_flags & IFF_UP) != 0;
    interface.running = (one->ifa_flags & IFF_RUNNING) != 0;
    interface.multicast = (one->ifa_flags & IFF_MULTICAST) != 0;
    if (one->ifa_addr && one->ifa_addr->sa_family == AF_INET)
      interface.addresses.push_back(dotted(*one->ifa_addr));
  }
  return interfaces;
}

std::optional<InterfaceObstacle> find_obstacle(const std::vector<NetworkInterface>& interfaces,
                                               const std::string& wanted, Carrier carrier) {
  // A loopback interface that has never been up has no address.
  const bool loopback = wanted.empty() || wanted == "lo" || wanted.starts_with("127.");
  const std::string name = loopback ? "lo" : wanted;
  for (const NetworkInterface& interface : interfaces) {
    const bool meant =
        interface.name == name || std::ranges::count(interface.addresses, wanted) > 0;
    if (!meant) continue;
    if (interface.up && !interface.running && carrier == Carrier::Needed) {
      return InterfaceObstacle{"the interface " + interface.name +
                                   " has no carrier: its cable, or the other end of it, is missing",
                               "ip link show dev " + interface.name};
    }
    if (interface.up && (loopback || !interface.addresses.empty())) continue;
    if (interface.up) {
      return InterfaceObstacle{
          "the interface " + interface.name + " has no IPv4 address, and Skein speaks IPv4",
          "sudo ip address add ADDRESS/PREFIX dev " + interface.name +
              ", or start its DHCP client"};
    }
    return InterfaceObstacle{
        loopback
            ? "the loopback interface is down: the peers of this host cannot speak to each other"
            : "the interface " + interface.name + " is down",
        "sudo ip link set " + interface.name + " up"};
  }
  return std::nullopt;
}

bool is_misspelled_interface(const std::string& wanted, const std::vector<std::string>& known) {
  const auto is_of_its_kind = [&](const std::string& name) {
    return without_numbers(name) == without_numbers(wanted);
  };
  return std::ranges::none_of(known, is_of_its_kind) && !suggestion(wanted, known).empty();
}

std::string obstacle_of_this_host(const std::vector<std::string>& wanted, Carrier carrier) {
  try {
    const auto interfaces = network_interfaces();
    for (const std::string& each : wanted.empty() ? std::vector<std::string>{""} : wanted) {
      if (const auto obstacle = find_obstacle(interfaces, each, carrier))
        return obstacle->problem + "; " + obstacle->remedy;
    }
  } catch (const Internal&) {  // what is told otherwise must do
  }
  return {};
}

}  // namespace skein
