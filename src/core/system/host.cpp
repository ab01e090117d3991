#include "core/system/host.hpp"

#include <netdb.h>
#include <strings.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <memory>

#include "core/system/network_interface.hpp"
#include "skein/error.hpp"

namespace skein {
namespace {

bool same_name(const std::string& a, const std::string& b) {
  return ::strcasecmp(a.c_str(), b.c_str()) == 0;
}

std::string first_label(const std::string& name) { return name.substr(0, name.find('.')); }

bool is_own_address(const std::string& address, const std::vector<HostInterface>& interfaces) {
  // All of 127.0.0.0/8 is this host, whether or not an interface lists it.
  return address.starts_with("127.") ||
         std::ranges::find(interfaces, address, &HostInterface::address) != interfaces.end();
}

}  // namespace

std::vector<HostInterface> interfaces_of_this_host() {
  std::vector<HostInterface> found;
  for (const NetworkInterface& interface : network_interfaces()) {
    for (const std::string& address : interface.addresses)
      found.push_back({interface.name, address});
  }
  return found;
}

std::string to_text(const std::vector<HostInterface>& interfaces) {
  std::string text;
  for (const HostInterface& interface : interfaces)
    text += (text.empty() ? "" : ", ") + interface.name + " (" + interface.address + ")";
  return text.empty() ? "none" : text;
}

std::vector<std::string> host_addresses(const std::string& host) {
  addrinfo wanted{};
  wanted.ai_family = AF_INET;
  wanted.ai_socktype = SOCK_DGRAM;
  addrinfo* list = nullptr;
  const int failure = getaddrinfo(host.c_str(), nullptr, &wanted, &list);
  if (failure != 0) {
    const std::string text = "host '" + host + "' has no IPv4 address: " + gai_strerror(failure);
    if (failure == EAI_AGAIN || failure == EAI_MEMORY || failure == EAI_SYSTEM)
      throw Unavailable(text);
    throw InvalidArgument(text);
  }
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> owner(list, freeaddrinfo);
  std::vector<std::string> addresses;
  for (const addrinfo* entry = list; entry != nullptr; entry = entry->ai_next)
    addresses.push_back(dotted(*entry->ai_addr));
  return addresses;
}

std::string name_of_this_host() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

bool is_this_host(const std::string& host) {
  const std::string own = name_of_this_host();
  if (same_name(host, own) || same_name(host, first_label(own))) return true;
  std::vector<std::string> addresses;
  try {
    addresses = host_addresses(host);
  } catch (const Error&) {
    return false;
  }
  const auto interfaces = interfaces_of_this_host();
  return std::ranges::any_of(
      addresses, [&](const std::string& address) { return is_own_address(address, interfaces); });
}

}  // namespace skein
