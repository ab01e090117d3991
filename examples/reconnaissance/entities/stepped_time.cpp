#include "stepped_time.hpp"

#include <utility>

namespace reconnaissance {

std::size_t SteppedTime::join(int period, Work work) {
  std::lock_guard lock(mutex_);
  members_.emplace(++last_, Member{period, std::move(work)});
  return last_;
}

void SteppedTime::leave(std::size_t number) {
  std::lock_guard lock(mutex_);
  members_.erase(number);
}

std::size_t SteppedTime::participants() const {
  std::lock_guard lock(mutex_);
  return members_.size();
}

void SteppedTime::step() {
  std::lock_guard lock(mutex_);
  ++tick_;
  for (const auto& [number, member] : members_)
    if (is_due(member.period, tick_)) member.work(tick_);
}

}  // namespace reconnaissance
