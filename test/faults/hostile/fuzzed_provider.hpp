#pragma once

#include <deque>
#include <set>

#include "test/faults/processes.hpp"
#include "test/tools/rtps_packet.hpp"

namespace skein::test {

/// A provider in a process of its own, a client whose packets to it are known, and a socket that
/// sends it what the test likes. For a network namespace where nobody else is.
class FuzzedProvider {
 public:
  FuzzedProvider();
  ~FuzzedProvider();
  FuzzedProvider(const FuzzedProvider&) = delete;
  FuzzedProvider& operator=(const FuzzedProvider&) = delete;

  /// What it received while a client found it, called it with small and large values, and left.
  const std::vector<Octets>& packets() const { return packets_; }

  /// The writers of a client that is still there, with samples of which it called.
  const std::set<Guid>& writers() const { return writers_; }

  /// To its ports for discovery and for samples. Waits while it has much to read; throws
  /// std::runtime_error where it reads no more.
  void send(const Octets& packet);

  /// Throws std::runtime_error, which says what is wrong, unless the process lives, falls idle, and
  /// answers a new client.
  void check_unharmed();

  /// What was sent last, in hexadecimal digits, a line each: for who looks for the culprit.
  std::string last_packets() const;

 private:
  std::size_t unread() const;
  void await_reading();

  ChildProcess server_;
  std::optional<ChildProcess> client_;
  std::vector<Octets> packets_;
  std::set<Guid> writers_;
  std::set<std::uint16_t> ports_;
  int socket_ = -1;
  std::size_t sent_ = 0;  // bytes since it was last seen reading
  std::deque<Octets> last_;
};

}  // namespace skein::test
