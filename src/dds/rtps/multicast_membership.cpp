#include "multicast_membership.hpp"

#include <arpa/inet.h>
#include <linux/netlink.h>
#include <linux/rtnetlink.h>
#include <netinet/in.h>
#include <poll.h>
#include <pthread.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "core/log.hpp"
#include "core/threads/stall_watch.hpp"
#include "core/threads/start_thread.hpp"
#include "dds/port/options_check.hpp"

namespace skein::dds {
namespace {

constexpr const char* kGroup = "239.255.0.1";

in_addr in_addr_of(const std::string& dotted) {
  in_addr address{};
  ::inet_pton(AF_INET, dotted.c_str(), &address);
  return address;
}

FileDescriptor open_changes() {
  FileDescriptor socket(
      ::socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC | SOCK_NONBLOCK, NETLINK_ROUTE));
  sockaddr_nl address{};
  address.nl_family = AF_NETLINK;
  address.nl_groups = RTMGRP_IPV4_IFADDR | RTMGRP_LINK;
  if (socket &&
      ::bind(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0)
    return socket;
  log(LogLevel::Warning, "dds",
      "the system does not tell of changes of the network (" +
          std::generic_category().message(errno) +
          "): where a network device goes and comes, others are not found by multicast any more");
  return FileDescriptor();
}

/// The local port of an IPv4 socket; 0 of anything else.
std::uint32_t udp_port(int descriptor) {
  sockaddr_in name{};
  socklen_t size = sizeof name;
  int type = 0;
  socklen_t type_size = sizeof type;
  if (::getsockname(descriptor, reinterpret_cast<sockaddr*>(&name), &size) != 0 ||
      name.sin_family != AF_INET ||
      ::getsockopt(descriptor, SOL_SOCKET, SO_TYPE, &type, &type_size) != 0 || type != SOCK_DGRAM) {
    return 0;
  }
  return ntohs(name.sin_port);
}

void join(int socket, const in_addr& interface) {
  const ip_mreq membership{in_addr_of(kGroup), interface};
  // Refused where it is a member already.
  ::setsockopt(socket, IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership, sizeof membership);
}

/// By the interface's new number; of a socket that sends by it.
void renew_outgoing(int socket, const in_addr& interface) {
  in_addr chosen{};
  socklen_t size = sizeof chosen;
  if (::getsockopt(socket, IPPROTO_IP, IP_MULTICAST_IF, &chosen, &size) != 0) return;
  if (chosen.s_addr != interface.s_addr) return;
  ::setsockopt(socket, IPPROTO_IP, IP_MULTICAST_IF, &interface, sizeof interface);
}

}  // namespace

MulticastMembership::MulticastMembership(const ParticipantOptions& options)
    : port_(domain_port(options.domain)),
      addresses_(interface_addresses(options.network)),
      changes_(open_changes()),
      end_(::eventfd(0, EFD_CLOEXEC)) {
  if (!changes_ || !end_) return;
  thread_ = start_thread("skein-dds-group", [this] { run(); });
  ::pthread_setname_np(thread_.native_handle(), "skein-dds-group");
}

MulticastMembership::~MulticastMembership() {
  if (!thread_.joinable()) return;
  ::eventfd_write(end_.get(), 1);
  thread_.join();
}

void MulticastMembership::run() {
  WatchedThread watched("skein-dds-group");
  std::array<pollfd, 2> events{pollfd{changes_.get(), POLLIN, 0}, pollfd{end_.get(), POLLIN, 0}};
  while (::poll(events.data(), events.size(), -1) >= 0 || errno == EINTR) {
    if (events[1].revents != 0) return;
    std::array<char, 16384> message;
    // What the messages say does not matter, nor that some were lost.
    while (::recv(changes_.get(), message.data(), message.size(), 0) > 0 || errno == ENOBUFS) {
    }
    watched.begin();
    join_again();
    watched.end();
  }
}

/// No vendor lends out its sockets. Other participants' on the same domain are joined, too, which
/// they are anyway.
void MulticastMembership::join_again() const {
  std::error_code error;
  for (const auto& each : std::filesystem::directory_iterator("/proc/self/fd", error)) {
    const int descriptor = std::atoi(each.path().filename().c_str());
    const std::uint32_t port = udp_port(descriptor);
    if (port == 0) continue;
    for (const std::string& address : addresses_) {
      const in_addr interface = in_addr_of(address);
      if (port == port_) join(descriptor, interface);
      renew_outgoing(descriptor, interface);
    }
  }
}

}  // namespace skein::dds
