#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <memory>
#include <mutex>
#include <string>

#include "rpc/service/invocation.hpp"
#include "skein/clock.hpp"

namespace skein::rpc {

class OwedAnswers;

/// The calls that a service has to finish before it may end: those it has accepted, and those that
/// are inside the implementation. Decides whether the service is closed. Thread-safe; while
/// they hold the lock, only close() and finish() use another part (streams, OwedAnswers), and
/// count() runs its predicate.
class UnfinishedCalls {
 public:
  /// Once `leaving` is true, finish() and await_end() hear of each call that ends.
  explicit UnfinishedCalls(std::shared_ptr<const std::atomic<bool>> leaving)
      : leaving_(std::move(leaving)) {}

  bool closed() const noexcept { return (accepted_ & kClosed) != 0; }

  /// Counts one more call that waits, is on a thread, or is being answered, until note_done();
  /// also if it returns false: the service is closed. Takes no lock.
  bool accept() noexcept { return (accepted_.fetch_add(1) & kClosed) == 0; }
  void note_done();
  bool none_accepted() const noexcept { return (accepted_ & ~kClosed) == 0; }

  /// An invocation that is inside the implementation, unless the service was closed before.
  class Running {
   public:
    Running(UnfinishedCalls& calls, Invocation& invocation);
    ~Running();
    Running(const Running&) = delete;
    Running& operator=(const Running&) = delete;

    bool admitted() const noexcept { return admitted_; }

   private:
    friend UnfinishedCalls;
    UnfinishedCalls& calls_;
    Invocation& invocation_;
    bool admitted_ = false;
    Running* before_ = nullptr;
    Running* next_ = nullptr;
  };

  /// How many of those that run `predicate` holds for; it is asked under the lock.
  template <class Predicate>
  std::size_t count(Predicate predicate) const {
    std::lock_guard lock(mutex_);
    std::size_t count = 0;
    for (const Running* each = running_; each; each = each->next_) {
      if (predicate(each->invocation_)) ++count;
    }
    return count;
  }

  /// Once leaving: waits until none is accepted, runs or is owed an answer, and closes at that
  /// moment; false, and closes nothing, at the deadline.
  bool finish(Clock& clock, Instant deadline, const OwedAnswers& owed);

  /// None enters the implementation from now on. Those inside are stopped as Disconnected.
  void close(const std::string& why);

  /// Once leaving: waits until none is inside the implementation; false at the deadline.
  bool await_end(std::chrono::steady_clock::time_point deadline) const;

 private:
  static constexpr std::size_t kClosed = ~(~std::size_t{0} >> 1);

  const std::shared_ptr<const std::atomic<bool>> leaving_;
  std::atomic<std::size_t> accepted_{0};  // and kClosed, so that none is accepted past it
  mutable std::mutex mutex_;
  mutable std::condition_variable less_to_do_;
  Running* running_ = nullptr;  // the first of a list of objects on the stacks of their threads
};

}  // namespace skein::rpc
