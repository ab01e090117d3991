#include "pending_calls.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace skein::rpc {

std::optional<std::uint64_t> PendingCalls::add(const Call& call) {
  std::uint64_t number;
  TimerId outdated;
  {
    std::lock_guard lock(mutex_);
    if (closed_) return std::nullopt;
    if (all_.size() >= most_) return 0;
    number = ++last_;
    all_.emplace(number, call);
    outdated = look_at(call->deadline());
  }
  if (outdated != 0) clock_.cancel(outdated);  // unlocked: it may be running
  return number;
}

PendingCalls::Removed PendingCalls::remove(std::uint64_t number, Keep keep) {
  std::lock_guard lock(mutex_);
  const auto found = all_.find(number);
  if (found == all_.end()) return {};
  if (keep == Keep::Streams && found->second->operation().stream) return {found->second, false};
  Removed removed{std::move(found->second), all_.size() == 1};
  all_.erase(found);
  return removed;
}

PendingCalls::All PendingCalls::close() {
  All waited{&call_memory()};
  TimerId outdated;
  {
    std::lock_guard lock(mutex_);
    closed_ = true;
    waited.swap(all_);
    outdated = std::exchange(timer_, 0);
    timer_due_ = Instant::max();
  }
  clock_.cancel(outdated);
  return waited;
}

bool PendingCalls::close_if_empty() {
  std::lock_guard lock(mutex_);
  if (!all_.empty()) return false;
  closed_ = true;
  return true;
}

std::size_t PendingCalls::size() const {
  std::lock_guard lock(mutex_);
  return all_.size();
}

std::uint64_t PendingCalls::total() const {
  std::lock_guard lock(mutex_);
  return last_;
}

// Under the lock: tell_due() will run then, or before. Returns a timer that is not needed any more.
TimerId PendingCalls::look_at(Instant deadline) {
  if (deadline >= timer_due_) return 0;
  timer_due_ = deadline;
  return std::exchange(timer_, clock_.call_at(deadline, [calls = weak_from_this()] {
    if (const auto self = calls.lock()) self->tell_due();
  }));
}

void PendingCalls::tell_due() {
  std::vector<std::uint64_t> due;
  {
    std::lock_guard lock(mutex_);
    const Instant now = clock_.now();
    timer_ = 0;
    timer_due_ = Instant::max();
    Instant next = Instant::max();
    for (const auto& [number, call] : all_) {
      if (call->deadline() <= now) {
        due.push_back(number);
      } else {
        next = std::min(next, call->deadline());
      }
    }
    look_at(next);
  }
  for (const std::uint64_t number : due) on_due_(number);
}

}  // namespace skein::rpc
