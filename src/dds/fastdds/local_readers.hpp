#pragma once

#include <chrono>
#include <mutex>
#include <set>

#include "dds/rtps/rtps_guard.hpp"

namespace skein::dds::fastdds {

class FastReader;

/// The readers of a participant, each from its creation to its removal.
class LocalReaders {
 public:
  explicit LocalReaders(RtpsGuard& guard) : guard_(guard) {}

  /// To be held while a reader is created or removed: Fast DDS forgets a local reader without a
  /// lock.
  std::mutex& creation() noexcept { return mutex_; }

  /// With creation() held.
  void add(FastReader& reader) { readers_.insert(&reader); }
  void remove(FastReader& reader);

  /// Drops samples in fragments that the guard gives up: Fast DDS keeps their memory for as long as
  /// their writer is there.
  void drop_incomplete(std::chrono::steady_clock::time_point now);

 private:
  RtpsGuard& guard_;
  std::mutex mutex_;
  std::set<FastReader*> readers_;
};

}  // namespace skein::dds::fastdds
