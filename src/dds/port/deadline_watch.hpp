#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <unordered_map>
#include <vector>

#include "dds/port/port.hpp"
#include "skein/clock.hpp"

namespace skein::dds {

/// Which instances are overdue. An instance is watched from its first sample until it ends.
class DeadlineWatch {
 public:
  explicit DeadlineWatch(Duration period) : period_(period) {}

  void heard(const KeyHash& key, Instant now);
  void ended(const KeyHash& key);

  /// Those not heard of for the period; each is due again a period later.
  std::vector<KeyHash> take_overdue(Instant now);

  /// When the next instance falls due, as things are.
  std::optional<Instant> next() const;

 private:
  const Duration period_;
  std::unordered_map<KeyHash, Instant> due_;
  std::set<std::pair<Instant, KeyHash>> order_;
};

/// A DeadlineWatch on a clock of its own accord. Thread-safe.
class DeadlineTimer {
 public:
  using Missed = std::function<void(const KeyHash&)>;

  /// `missed` is called on the clock's thread.
  DeadlineTimer(Clock& clock, Duration period, Missed missed);
  /// Waits until `missed` does not run; not from it.
  ~DeadlineTimer();
  void heard(const KeyHash& key);
  void ended(const KeyHash& key);

 private:
  void schedule();
  void run();

  Clock& clock_;
  const Missed missed_;
  std::mutex mutex_;
  DeadlineWatch watch_;
  TimerId timer_ = 0;
  bool scheduled_ = false;
  bool closed_ = false;
};

/// A timer where a deadline is wanted, or nothing. Without `clock` it is the machine's: one for all
/// vendors and the whole process, whose thread is started with the first deadline.
std::unique_ptr<DeadlineTimer> make_deadline_timer(const Qos& qos, DeadlineTimer::Missed missed,
                                                   Clock* clock = nullptr);

}  // namespace skein::dds
