#include "fast_lease_watch.hpp"

#include <algorithm>
#include <limits>

namespace skein::dds::fastdds {
namespace {

constexpr auto kForever = std::numeric_limits<FastLeaseWatch::Duration::rep>::max();

}  // namespace

// The time without the pauses.
FastLeaseWatch::Duration::rep FastLeaseWatch::counted(Time now) const {
  return now.time_since_epoch().count() - pauses_.load(std::memory_order_relaxed);
}

void FastLeaseWatch::follow(const Guid& participant, std::optional<Duration> lease, Time now) {
  std::lock_guard lock(mutex_);
  Followed& followed = followed_[participant];
  followed.last = counted(now);
  followed.lease = lease ? lease->count() : kForever;
}

void FastLeaseWatch::forget(const Guid& participant) {
  constexpr std::size_t kMany = 4096;  // that went and may come back
  std::lock_guard lock(mutex_);
  followed_.erase(participant);
  if (returned_.size() >= kMany) returned_.clear();
  returned_[participant] = 0;
}

bool FastLeaseWatch::heard(const Guid& participant, Time now) {
  constexpr Duration kJust = std::chrono::milliseconds(100);
  std::shared_lock lock(mutex_);
  const auto found = followed_.find(participant);
  if (found != followed_.end()) {
    found->second.last.store(counted(now), std::memory_order_relaxed);
  }
  const auto lost = returned_.find(participant);
  if (lost == returned_.end()) return false;
  const auto present = now.time_since_epoch().count();
  Duration::rep returned = 0;
  if (lost->second.compare_exchange_strong(returned, present)) returned = present;
  return present - returned < kJust.count();
}

std::vector<Guid> FastLeaseWatch::watch(Time now, Duration period) {
  std::lock_guard watching(watching_);
  const Duration passed = last_watch_ == Time{} ? Duration::zero() : now - last_watch_;
  last_watch_ = now;
  pauses_ += std::max(passed - 2 * period, Duration::zero()).count();
  const auto present = counted(now);
  std::vector<Guid> overdue;
  std::lock_guard lock(mutex_);
  for (auto& [participant, followed] : followed_) {
    // What came after a pause was noted before the pause was known.
    followed.last = std::min(followed.last.load(), present);
    if (present - followed.last > followed.lease) overdue.push_back(participant);
  }
  for (const Guid& participant : overdue) followed_.erase(participant);
  return overdue;
}

std::vector<Guid> FastLeaseWatch::drop_all() {
  std::vector<Guid> all;
  std::lock_guard lock(mutex_);
  for (const auto& [participant, followed] : followed_) all.push_back(participant);
  followed_.clear();
  return all;
}

bool FastLeaseWatch::alive(const Guid& participant, Duration lease, Time now) const {
  std::shared_lock lock(mutex_);
  const auto found = followed_.find(participant);
  return found == followed_.end() || counted(now) - found->second.last <= lease.count();
}

}  // namespace skein::dds::fastdds
