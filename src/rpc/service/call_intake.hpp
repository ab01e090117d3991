#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>

#include "rpc/service/fair_queue.hpp"
#include "rpc/service/invocation.hpp"
#include "rpc/service/owed_answers.hpp"
#include "rpc/service/service_owner.hpp"
#include "rpc/service/unfinished_calls.hpp"
#include "skein/error.hpp"

namespace skein::rpc {

/// Decides which invocations may wait for a service's threads, and which is next. Thread-safe; uses
/// OwedAnswers while it holds its lock, and is asked its size() under a stream's.
class CallIntake {
 public:
  /// `calls` and `owed` outlive it. For `capacity` see FairQueue.
  CallIntake(std::string_view service, std::size_t capacity, UnfinishedCalls& calls,
             const OwedAnswers& owed)
      : service_(service), calls_(calls), owed_(owed), queue_(capacity) {}

  /// Throws NotSent once the service is closed, and Overloaded if the connection has no room left
  /// or, for a call that is `answered_later`, may not be owed one more answer.
  void add(std::shared_ptr<Invocation> invocation, bool answered_later);

  /// Null if none waits; after close() of the calls, none comes then.
  std::shared_ptr<Invocation> take();
  std::size_t size() const;

 private:
  const std::string_view service_;
  UnfinishedCalls& calls_;
  const OwedAnswers& owed_;
  mutable std::mutex mutex_;
  FairQueue queue_;
};

// Accepted under the lock: an invocation that comes before the end is in the queue when close()
// empties it. note_done() comes after the lock was given back: it may take
// the lock of UnfinishedCalls, which comes before this one. Locking does not throw.
inline void CallIntake::add(std::shared_ptr<Invocation> invocation, bool answered_later) {
  try {
    std::lock_guard lock(mutex_);
    if (!calls_.accept()) throw being_withdrawn(service_);
    if (!queue_.has_room(invocation->connection)) {
      throw Overloaded("the queue of " + std::string(service_) +
                       " is full; the call was not executed");
    }
    if (answered_later && !owed_.has_room(invocation->connection)) {
      throw Overloaded(std::string(service_) +
                       " owes as many answers as it may; the call was not executed");
    }
    queue_.push(std::move(invocation));
  } catch (...) {
    calls_.note_done();
    throw;
  }
}

inline std::shared_ptr<Invocation> CallIntake::take() {
  std::lock_guard lock(mutex_);
  return queue_.pop();
}

inline std::size_t CallIntake::size() const {
  std::lock_guard lock(mutex_);
  return queue_.size();
}

}  // namespace skein::rpc
