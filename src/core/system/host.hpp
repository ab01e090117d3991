#pragma once

#include <string>
#include <vector>

/// This machine as others address it, in the caller's network namespace; IPv4 alone.
namespace skein {

/// An address of one of its network interfaces.
struct HostInterface {
  std::string name;
  std::string address;  ///< In dotted form.
};

/// Throws Internal where the system does not tell.
std::vector<HostInterface> interfaces_of_this_host();

/// `lo (127.0.0.1), eth0 (10.0.0.2)`, or `none`.
std::string to_text(const std::vector<HostInterface>& interfaces);

/// The addresses of a host by name or address, in dotted form. Throws InvalidArgument where it has
/// none, Unavailable where the network's name servers, which it may ask, do not answer.
std::vector<std::string> host_addresses(const std::string& host);

/// Whether `host` is this machine: its name, short or whole, an address of its interfaces, or a
/// name that resolves to one. May ask the network's name servers.
bool is_this_host(const std::string& host);

/// The machine's own name.
std::string name_of_this_host();

}  // namespace skein
