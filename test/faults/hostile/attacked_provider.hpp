#pragma once

#include <arpa/inet.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdio>
#include <fstream>

#include "test/faults/processes.hpp"
#include "test/tools/invented_peer.hpp"
#include "test/tools/wire_tap.hpp"

namespace skein::test {

/// Sends what one likes from and to addresses of this host (IPv4, in host order).
class RawSocket {
 public:
  explicit RawSocket(std::uint32_t from = INADDR_LOOPBACK)
      : socket_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    const sockaddr_in own = place(from, 0);
    if (bind(socket_, reinterpret_cast<const sockaddr*>(&own), sizeof own) != 0) {
      throw std::runtime_error("this host has not that address");
    }
  }
  ~RawSocket() { close(socket_); }
  RawSocket(const RawSocket&) = delete;
  RawSocket& operator=(const RawSocket&) = delete;

  void send(const Octets& packet, std::uint16_t port, std::uint32_t to = INADDR_LOOPBACK) const {
    const sockaddr_in other = place(to, port);
    sendto(socket_, packet.data(), packet.size(), 0, reinterpret_cast<const sockaddr*>(&other),
           sizeof other);
  }

 private:
  static sockaddr_in place(std::uint32_t address, std::uint16_t port) {
    sockaddr_in result{};
    result.sin_family = AF_INET;
    result.sin_addr.s_addr = htonl(address);
    result.sin_port = htons(port);
    return result;
  }

  const int socket_;
};

/// The UDP ports on which a process's participants of domain 17 receive; from others they send.
inline std::set<std::uint16_t> receiving_ports_of(pid_t process) {
  constexpr std::uint16_t kFirst = 7400 + 250 * 17;  // RTPS 9.6.1
  std::set<std::uint16_t> ports;
  for (const std::uint16_t port : udp_ports_of(process)) {
    if (port >= kFirst && port < kFirst + 250) ports.insert(port);
  }
  return ports;
}

/// A provider of the echo service in a process of its own, and a socket that sends it what a
/// stranger would. For a network namespace where nobody else is.
class AttackedProvider {
 public:
  static constexpr const char* kRequestTopic = "test/LouderEcho_Request";
  static constexpr const char* kRequestType = "test::LouderEcho_Request";
  static constexpr const char* kReplyTopic = "test/LouderEcho_Reply";
  static constexpr const char* kReplyType = "test::LouderEcho_Reply";

  AttackedProvider() : server_(start_provider("server", *Pairing::get().server)) {
    ports_ = receiving_ports_of(server_.pid());
    // What makes it take all memory is not to take the machine's.
    constexpr rlim_t kEnough = rlim_t{6} << 30;
    const rlimit limit{kEnough, kEnough};
    prlimit(server_.pid(), RLIMIT_AS, &limit, nullptr);
  }
  ChildProcess& process() { return server_; }

  /// To all its ports, for discovery and for samples. Waits while it has much to read.
  void send(const RtpsPacket& packet) { send(packet.octets()); }
  void send(const Octets& packet) {
    constexpr std::size_t kRoom = 64'000;
    constexpr std::size_t kOverhead = 768;  // what a small packet takes of a socket's room
    for (const std::uint16_t port : ports_) socket_.send(packet, port);
    sent_ += packet.size() + kOverhead;
    if (sent_ < kRoom) return;
    if (!has_read_all(std::chrono::seconds(60))) throw std::runtime_error("it reads no more");
    sent_ = 0;
  }

  /// Whether it comes, in that time, to have read all that was sent. Says where something is left.
  bool has_read_all(std::chrono::seconds limit) const {
    if (eventually([&] { return unread_bytes(ports_) == 0; }, limit)) return true;
    for (const std::uint16_t port : ports_) {
      std::fprintf(stderr, "port %u: %zu octets are not read\n", port, unread_bytes({port}));
    }
    return false;
  }

  /// Makes `peer` known to it, with endpoints that match the provider's own.
  void introduce(const InventedPeer& peer) {
    send(peer.announcement());
    send(peer.endpoint(peer.writer(1), kRequestTopic, kRequestType, 1));
    send(peer.endpoint(peer.reader(2), kReplyTopic, kReplyType, 1));
  }

  /// Resident memory now, in MiB.
  std::size_t resident_mib() const {
    std::ifstream status("/proc/" + std::to_string(server_.pid()) + "/status");
    for (std::string line; std::getline(status, line);) {
      if (line.starts_with("VmRSS:")) return std::stoull(line.substr(6)) / 1024;
    }
    throw std::runtime_error("it has died");
  }

  /// Whether a client that has just come is answered, within `limit` in all: small and large.
  void check_answers(std::chrono::seconds limit = std::chrono::seconds(10)) {
    auto client = start_peer("client", *Pairing::get().client);
    const auto start = std::chrono::steady_clock::now();
    CHECK_THAT(client.ask("connect", limit), Catch::StartsWith("connected"));
    CHECK_THAT(client.ask("echo 3 hello", limit), Catch::StartsWith("echoed"));
    CHECK_THAT(client.ask("octets 300000 many", limit), Catch::StartsWith("echoed"));
    CHECK(std::chrono::steady_clock::now() - start < limit);
    client.finish();
  }

 private:
  ChildProcess server_;
  std::set<std::uint16_t> ports_;
  RawSocket socket_;
  std::size_t sent_ = 0;  // bytes since it was last seen reading
};

}  // namespace skein::test
