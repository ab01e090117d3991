#pragma once

#include <cstdint>
#include <string>
#include <thread>
#include <vector>

#include "core/system/file_descriptor.hpp"
#include "dds/port/port.hpp"

namespace skein::dds {

/// Keeps a participant that discovers others by multicast in RTPS's group, for as long as this
/// lives. A network device that goes takes the memberships of all sockets with it, and the choice
/// of the device for what they send; vendors join once. Whenever the system tells of an address of
/// one of the participant's interfaces, its process's sockets join again. Has a thread.
class MulticastMembership {
 public:
  /// Once the participant has its sockets. In the network namespace of the calling thread.
  explicit MulticastMembership(const ParticipantOptions& options);
  ~MulticastMembership();
  MulticastMembership(const MulticastMembership&) = delete;
  MulticastMembership& operator=(const MulticastMembership&) = delete;

 private:
  void run();
  void join_again() const;

  const std::uint32_t port_;
  const std::vector<std::string> addresses_;
  FileDescriptor changes_;
  FileDescriptor end_;
  std::thread thread_;
};

}  // namespace skein::dds
