#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <memory_resource>
#include <mutex>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "skein/detail/call_memory.hpp"
#include "skein/detail/pending_reply.hpp"
#include "skein/guid.hpp"

namespace skein::rpc {

/// The calls that a service's implementation answers later. It may owe as many answers as
/// invocations may wait, and a peer its share of them, by the rule of FairQueue. Thread-safe; uses
/// no other part while it holds its lock.
class OwedAnswers {
 public:
  explicit OwedAnswers(std::size_t capacity) : capacity_(capacity) {}

  /// Whether the peer of that connection may be owed one more: no more than there is room left.
  bool has_room(const Guid& connection) const;

  /// Without regard to has_room(). False once closed: close() would not have returned it.
  bool add(PendingReply& owed, const Guid& connection);
  /// Does nothing if it is not owed.
  void remove(PendingReply& owed, const Guid& connection);
  std::size_t size() const;

  /// Takes no more. Returns those that are owed now.
  std::vector<std::shared_ptr<PendingReply>> close();

 private:
  const std::size_t capacity_;
  mutable std::mutex mutex_;
  bool closed_ = false;
  std::pmr::unordered_set<PendingReply*> owed_{&call_memory()};
  std::pmr::unordered_map<Guid, std::size_t> by_peer_{&call_memory()};  // none is 0
};

inline bool OwedAnswers::has_room(const Guid& connection) const {
  std::lock_guard lock(mutex_);
  const auto of_peer = by_peer_.find(connection.participant());
  return (of_peer == by_peer_.end() ? 0 : of_peer->second) <
         capacity_ - std::min(capacity_, owed_.size());
}

inline bool OwedAnswers::add(PendingReply& owed, const Guid& connection) {
  std::lock_guard lock(mutex_);
  if (closed_) return false;
  owed_.insert(&owed);
  ++by_peer_[connection.participant()];
  return true;
}

inline void OwedAnswers::remove(PendingReply& owed, const Guid& connection) {
  std::lock_guard lock(mutex_);
  if (owed_.erase(&owed) == 0) return;
  const auto of_peer = by_peer_.find(connection.participant());
  if (--of_peer->second == 0) by_peer_.erase(of_peer);
}

inline std::size_t OwedAnswers::size() const {
  std::lock_guard lock(mutex_);
  return owed_.size();
}

inline std::vector<std::shared_ptr<PendingReply>> OwedAnswers::close() {
  std::vector<std::shared_ptr<PendingReply>> owed;
  std::lock_guard lock(mutex_);
  closed_ = true;
  for (PendingReply* const each : owed_) {
    // One that loses its last copy just now waits for the lock in remove().
    if (auto alive = each->weak_from_this().lock()) owed.push_back(std::move(alive));
  }
  return owed;
}

}  // namespace skein::rpc
