#pragma once

#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>

#include "core/weak_list.hpp"
#include "skein/clock.hpp"
#include "skein/executor.hpp"

namespace skein::connector {

class WaitingCall;

/// Counts the changes of the providers that stand, and wakes the calls that wait for the next one.
/// A caller's thread blocks in await(). A WaitingCall has no thread: it looks in a task of
/// `continuations`. Thread-safe.
class ProviderChanges {
 public:
  ProviderChanges(Clock& clock, Executor& continuations)
      : clock_(clock), continuations_(continuations) {}

  /// Keeps the `source`, which calls on_change(), until close().
  void follow(std::shared_ptr<void> source);
  /// Other providers stand than before. Does not block.
  void on_change();

  std::uint64_t count() const;

  /// Blocks until the first change after `seen`. Returns false if the deadline or close() came
  /// first.
  bool await(std::uint64_t seen, Instant deadline);
  /// Lets the call look again at the first change after `seen`, or at close(). Returns false after
  /// close().
  bool tell(std::uint64_t seen, std::weak_ptr<WaitingCall> call);

  /// Ends all waits, now and from now on.
  void close();

 private:
  void wake(WeakList<WaitingCall>::List calls);

  Clock& clock_;
  Executor& continuations_;
  mutable std::mutex mutex_;  // guards the members below
  std::condition_variable changed_;
  std::uint64_t count_ = 0;
  bool closed_ = false;
  WeakList<WaitingCall> waiting_;
  std::shared_ptr<void> source_;
};

}  // namespace skein::connector
