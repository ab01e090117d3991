#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <memory>

#include "rpc/service/call_accounts.hpp"
#include "rpc/service/invocation.hpp"
#include "rpc/service/owed_answers.hpp"
#include "rpc/service/unfinished_calls.hpp"
#include "skein/clock.hpp"
#include "skein/detail/operation.hpp"
#include "skein/guid.hpp"

namespace skein::rpc {

class Service;

/// Runs a service's invocations on the thread that calls it; answers at once, later or as a stream.
/// Service chooses that thread: see its comment in service.hpp. Thread-safe.
class CallExecution {
 public:
  /// All outlive it.
  struct Parts {
    Service& service;  ///< Only kept, weakly, by those that are answered later.
    Servant& servant;
    Clock& clock;
    const Guid& strand;
    const std::shared_ptr<const void>& keeps;  ///< See Service::Options.
    CallAccounts& accounts;
    UnfinishedCalls& calls;
    OwedAnswers& owed;
    std::function<bool()> others_wait;  ///< For the thread; a stream asks it under its lock.
  };

  explicit CallExecution(Parts parts) : parts_(std::move(parts)) {}

  /// Whether the implementation may answer after it has returned.
  bool answers_later(const OperationInfo& operation) const noexcept;

  /// Runs and answers it, unless the service is closed, or its `turn_came` too late.
  void run(const std::shared_ptr<Invocation>& invocation, bool turn_came, Instant now);

  /// Whether the latest that run() has run, of those that are no streams, took over a millisecond.
  bool latest_was_long() const noexcept { return latest_was_long_.load(std::memory_order_relaxed); }

  /// Runs the operation and answers nobody: the outcome is in `out` or thrown.
  void call(const OperationInfo& operation, const void* in, void* out, Invocation& frame);

  /// Throws TimedOut if it ended after its deadline: an implementation that saw its deadline pass
  /// may have given up, or returned a part, and that is no result.
  void refuse_too_late(const OperationInfo& operation, const Invocation& frame) const;

  /// Answers one that was not run: the service is being withdrawn.
  void withdraw(Invocation& invocation);

  /// Ends those that are owed an answer as Disconnected; none is owed from now on.
  void withdraw_owed();

 private:
  class Deferred;

  void run_now(Invocation& invocation);
  void run_deferred(const std::shared_ptr<Invocation>& invocation);
  void end(Deferred& deferred, std::exception_ptr error);
  void answer(Invocation& invocation, const void* out, std::exception_ptr error);
  template <class Action>
  void enter(const OperationInfo& operation, Invocation& frame, Action action);
  template <class Action>
  void account(const OperationInfo& operation, const void* out, Invocation& frame,
               CallRecorder::Tap& tap, Action action);

  const Parts parts_;
  std::atomic<bool> latest_was_long_{false};
};

}  // namespace skein::rpc
