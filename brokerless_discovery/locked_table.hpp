#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "brokerless_discovery/departures.hpp"
#include "core/clock_wait.hpp"
#include "observers.hpp"
#include "skein/error.hpp"

namespace skein::brokerless_discovery {

/// The table under its lock, which also gives the changes their order and wakes threads that wait
/// for one. Thread-safe.
class LockedTable {
 public:
  /// Departures are noted of the services that `asker` manages.
  LockedTable(Clock& clock, Observers& observers, std::string asker)
      : clock_(clock), observers_(observers), asker_(std::move(asker)) {}

  /// Lets `event` change the table, and returns the changes. A caller that holds a lock calls
  /// Observers::tell_later() when it has let go of it; others use apply().
  template <class Event>
  Table::Changes change(Event event) {
    std::lock_guard lock(mutex_);
    Table::Changes changes = event(table_);
    if (changes.empty()) return changes;
    departures_.note(changes, asker_, clock_.now());
    ++generation_;
    changed_.notify_all();
    observers_.note(changes);
    return changes;
  }
  template <class Event>
  Table::Changes apply(Event event) {
    Table::Changes changes = change(event);
    if (!changes.empty()) observers_.tell_later();
    return changes;
  }

  /// Returns the result of `look` for the table.
  template <class Look>
  auto look(Look look) const {
    std::lock_guard lock(mutex_);
    return look(table_);
  }
  std::set<Guid> take_contradicted() {
    std::lock_guard lock(mutex_);
    return table_.take_contradicted();
  }
  bool take_room_again() {
    std::lock_guard lock(mutex_);
    return table_.take_room_again();
  }
  std::vector<Absence> absent(std::string_view service) const {
    std::lock_guard lock(mutex_);
    return departures_.of(service);
  }
  /// Grows with each change. Takes no lock.
  std::uint64_t generation() const noexcept { return generation_; }

  /// Waits until something is found, until end_waits(), or until `deadline`.
  Table::Found await(const Query& query, Instant deadline) const {
    std::unique_lock lock(mutex_);
    Table::Found found;
    wait_until(clock_, deadline, lock, changed_, [&] {
      found = table_.find(query);
      return waits_ended_ || !found.empty();
    });
    return found;
  }
  /// Returns false at `deadline`. Throws Unavailable after end_waits().
  bool await_change(std::uint64_t seen, Instant deadline) const {
    std::unique_lock lock(mutex_);
    const bool changed = wait_until(clock_, deadline, lock, changed_,
                                    [&] { return waits_ended_ || generation_ != seen; });
    if (waits_ended_) throw Unavailable("the entity that waited for a service has ended");
    return changed;
  }
  void end_waits() {
    std::lock_guard lock(mutex_);
    waits_ended_ = true;
    changed_.notify_all();
  }
  bool waits_ended() const {
    std::lock_guard lock(mutex_);
    return waits_ended_;
  }

 private:
  Clock& clock_;
  Observers& observers_;
  const std::string asker_;
  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  bool waits_ended_ = false;
  Table table_;
  Departures departures_;
  std::atomic<std::uint64_t> generation_{0};  // written under the lock
};

}  // namespace skein::brokerless_discovery
