#pragma once

#include <condition_variable>
#include <mutex>
#include <set>
#include <string>

#include "harness/peer.hpp"
#include "skein/error.hpp"

namespace skein::benchmarks {

/// The peers that are known, oneself among them if it is added. Thread-safe.
template <class Id>
class Census {
 public:
  void add(const Id& peer) {
    std::lock_guard lock(mutex_);
    known_.insert(peer);
    changed_.notify_all();
  }

  void remove(const Id& peer) {
    std::lock_guard lock(mutex_);
    known_.erase(peer);
  }

  /// Throws Internal after kJoinPatience.
  void await(std::size_t count) {
    std::unique_lock lock(mutex_);
    if (changed_.wait_for(lock, kJoinPatience, [&] { return known_.size() >= count; })) return;
    throw Internal("heard of " + std::to_string(known_.size()) + " of " + std::to_string(count) +
                   " peers");
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::set<Id> known_;
};

}  // namespace skein::benchmarks
