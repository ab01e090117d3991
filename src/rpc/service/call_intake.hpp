#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <string_view>

#include "rpc/service/fair_queue.hpp"
#include "rpc/service/invocation.hpp"
#include "rpc/service/owed_answers.hpp"
#include "rpc/service/unfinished_calls.hpp"

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

}  // namespace skein::rpc
