#include "rpc/service/owed_answers.hpp"

#include <algorithm>
#include <utility>

namespace skein::rpc {

bool OwedAnswers::has_room(const Guid& connection) const {
  std::lock_guard lock(mutex_);
  const auto of_peer = by_peer_.find(connection.participant());
  return (of_peer == by_peer_.end() ? 0 : of_peer->second) <
         capacity_ - std::min(capacity_, owed_.size());
}

bool OwedAnswers::add(PendingReply& owed, const Guid& connection) {
  std::lock_guard lock(mutex_);
  if (closed_) return false;
  owed_.insert(&owed);
  ++by_peer_[connection.participant()];
  return true;
}

void OwedAnswers::remove(PendingReply& owed, const Guid& connection) {
  std::lock_guard lock(mutex_);
  if (owed_.erase(&owed) == 0) return;
  const auto of_peer = by_peer_.find(connection.participant());
  if (--of_peer->second == 0) by_peer_.erase(of_peer);
}

std::size_t OwedAnswers::size() const {
  std::lock_guard lock(mutex_);
  return owed_.size();
}

std::vector<std::shared_ptr<PendingReply>> OwedAnswers::close() {
  std::vector<std::shared_ptr<PendingReply>> owed;
  std::lock_guard lock(mutex_);
  closed_ = true;
  for (PendingReply* const each : owed_) {
    // One whose last copy goes just now waits for the lock in remove().
    if (auto alive = each->weak_from_this().lock()) owed.push_back(std::move(alive));
  }
  return owed;
}

}  // namespace skein::rpc
