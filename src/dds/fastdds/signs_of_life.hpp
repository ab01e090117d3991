#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <shared_mutex>
#include <unordered_map>

#include "skein/core/guid.hpp"

namespace skein::dds::fastdds {

/// When participants were last heard of: the base of automatic liveliness. Fast DDS has a
/// liveliness of its own for readers, whose timer walks the list of local readers without a lock: a
/// participant that wakes after its leases ran out, and closes its sessions, crashed about one time
/// in eighty. So no reader tells Fast DDS of a lease, and what the transport receives is watched
/// instead.
class SignsOfLife {
 public:
  using Clock = std::chrono::steady_clock;

  /// Begins to watch a participant, heard of just now, or goes on.
  void follow(const Guid& participant);
  void forget(const Guid& participant);

  /// Notes the sender of an RTPS message. Whether it is one that had been forgotten and has just
  /// come back. Thread-safe, as all here.
  bool heard(const unsigned char* message, std::size_t size);

  /// Whether a participant that is followed was heard of in the last `lease`; true for others.
  bool alive(const Guid& participant, std::chrono::nanoseconds lease) const;

 private:
  mutable std::shared_mutex mutex_;
  std::unordered_map<Guid, std::atomic<Clock::rep>> last_;
  std::unordered_map<Guid, std::atomic<Clock::rep>>
      returned_;  // forgotten; when heard of again, or 0
};

}  // namespace skein::dds::fastdds
