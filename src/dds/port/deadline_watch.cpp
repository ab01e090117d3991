#include "deadline_watch.hpp"

namespace skein::dds {

void DeadlineWatch::heard(const KeyHash& key, Instant now) {
  const Instant due = saturating_sum(now, period_);
  const auto [found, fresh] = due_.try_emplace(key, due);
  if (fresh) {
    order_.emplace(due, key);
    return;
  }
  auto place = order_.extract({found->second, key});  // and not erased: nothing is allocated
  place.value().first = due;
  order_.insert(std::move(place));
  found->second = due;
}

void DeadlineWatch::ended(const KeyHash& key) {
  const auto found = due_.find(key);
  if (found == due_.end()) return;
  order_.erase({found->second, key});
  due_.erase(found);
}

std::vector<KeyHash> DeadlineWatch::take_overdue(Instant now) {
  std::vector<KeyHash> overdue;
  while (!order_.empty() && order_.begin()->first <= now) {
    overdue.push_back(order_.begin()->second);
    heard(overdue.back(), now);
  }
  return overdue;
}

std::optional<Instant> DeadlineWatch::next() const {
  if (order_.empty()) return std::nullopt;
  return order_.begin()->first;
}

DeadlineTimer::DeadlineTimer(Clock& clock, Duration period, Missed missed)
    : clock_(clock), missed_(std::move(missed)), watch_(period) {}

DeadlineTimer::~DeadlineTimer() {
  TimerId timer = 0;
  {
    std::lock_guard lock(mutex_);
    closed_ = true;
    timer = timer_;
  }
  clock_.cancel(timer);
}

void DeadlineTimer::heard(const KeyHash& key) {
  std::lock_guard lock(mutex_);
  watch_.heard(key, clock_.now());
  schedule();
}

void DeadlineTimer::ended(const KeyHash& key) {
  std::lock_guard lock(mutex_);
  watch_.ended(key);
}

/// A timer that comes too early finds nothing overdue and sets the next: so a steady flow sets one
/// timer a period, not one a sample.
void DeadlineTimer::schedule() {
  const auto next = watch_.next();
  if (scheduled_ || closed_ || !next) return;
  scheduled_ = true;
  timer_ = clock_.call_at(*next, [this] { run(); });
}

void DeadlineTimer::run() {
  std::vector<KeyHash> overdue;
  {
    std::lock_guard lock(mutex_);
    if (closed_) return;
    overdue = watch_.take_overdue(clock_.now());
  }
  for (const KeyHash& key : overdue) missed_(key);
  std::lock_guard lock(mutex_);
  scheduled_ = false;
  schedule();
}

std::unique_ptr<DeadlineTimer> make_deadline_timer(const Qos& qos, DeadlineTimer::Missed missed,
                                                   Clock* clock) {
  if (!qos.deadline) return nullptr;
  if (!clock) {
    // Never destroyed: participants may be static objects.
    static auto* const machine = new SystemClock;
    clock = machine;
  }
  return std::make_unique<DeadlineTimer>(*clock, *qos.deadline, std::move(missed));
}

}  // namespace skein::dds
