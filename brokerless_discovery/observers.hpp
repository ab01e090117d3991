#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include "brokerless_discovery/table.hpp"
#include "skein/executor.hpp"

namespace skein::brokerless_discovery {

/// Tells observers each change of the table, one at a time and in order, on `control`. Takes no
/// other lock under its own. Thread-safe.
class Observers {
 public:
  /// Once gone, it is not called any more. Recursive, so that an observer may let itself go.
  struct Observer {
    explicit Observer(std::function<void(const Change&)> tell_) : tell(std::move(tell_)) {}
    const std::function<void(const Change&)> tell;
    std::recursive_mutex telling;
    bool gone = false;
  };

  /// The tasks on `control` do nothing once `owner` has gone.
  Observers(Executor& control, const std::weak_ptr<void>& owner)
      : control_(control), owner_(owner) {}

  std::shared_ptr<Observer> add(std::function<void(const Change&)> observer);
  /// Waits for a call of it on another thread.
  void remove(const std::shared_ptr<Observer>& observer);

  /// Queues the changes. Call it under the table's lock, which gives them their order, and
  /// tell_later() without it.
  void note(const Table::Changes& changes);
  void tell_later();

 private:
  void tell();

  Executor& control_;
  const std::weak_ptr<void>& owner_;
  std::mutex mutex_;
  std::vector<std::shared_ptr<Observer>> observers_;
  Table::Changes untold_;
  bool telling_ = false;  // a task on `control` will tell them
};

}  // namespace skein::brokerless_discovery
