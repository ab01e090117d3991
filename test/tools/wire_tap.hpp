#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <set>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "skein/guid.hpp"

namespace skein::test {

/// One IPv4 packet as it left a device. Addresses and ports are in host order; ports are 0 unless
/// UDP.
struct Packet {
  std::uint32_t source = 0;
  std::uint32_t destination = 0;
  std::uint16_t source_port = 0;
  std::uint16_t destination_port = 0;
  std::uint8_t protocol = 0;
  std::vector<std::byte> content;

  /// Neither end is outside of 127.0.0.0/8.
  bool stays_on_loopback() const noexcept {
    return source >> 24 == 127 && destination >> 24 == 127;
  }
};

/// Writes down every IPv4 packet that leaves any device of the network namespace in which it is
/// made.
class WireTap {
 public:
  /// Ends the program as skipped where packets may not be captured.
  WireTap();
  ~WireTap();
  WireTap(const WireTap&) = delete;
  WireTap& operator=(const WireTap&) = delete;

  /// How many packets so far are such. Any thread.
  int count(const std::function<bool(const Packet&)>& such) const;

  /// Ends the capture and returns it. Throws std::runtime_error where the kernel had to drop some.
  std::vector<Packet> stop();

 private:
  void run();
  void end();

  int socket_ = -1;
  int wake_ = -1;
  mutable std::mutex mutex_;
  std::vector<Packet> packets_;
  std::thread thread_;
};

/// A DATA or DATA_FRAG submessage of a writer that is no part of DDS's own discovery.
struct DataSubmessage {
  Guid writer;
  bool fragment = false;
  std::string_view payload;  ///< With the submessage's own header fields; points into the packet.
};

/// Those in a packet; none where it is no RTPS message.
std::vector<DataSubmessage> user_data(const Packet& packet);

/// The UDP ports to which a process listens.
std::set<std::uint16_t> udp_ports_of(pid_t process);

/// What waits to be read at those UDP ports of the test's network namespace.
std::size_t unread_bytes(const std::set<std::uint16_t>& ports);

}  // namespace skein::test
