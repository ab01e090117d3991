#pragma once

#include <atomic>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <string>

#include "skein/core/action.hpp"
#include "skein/core/clock.hpp"
#include "skein/core/executor.hpp"
#include "skein/core/operation.hpp"

namespace skein {

/// One call on its way: finished exactly once, by a reply or by an error, whichever claims it
/// first. Shared by the caller and the lane that carries it.
class PendingCall : public std::enable_shared_from_this<PendingCall> {
 public:
  /// `out` is the operation's out struct; it lives until this is finished.
  PendingCall(const OperationInfo& operation, void* out, Instant deadline, bool blocking)
      : operation_(operation), out_(out), deadline_(deadline), blocking_(blocking) {}
  virtual ~PendingCall() = default;

  const OperationInfo& operation() const noexcept { return operation_; }
  void* out() const noexcept { return out_; }
  Instant deadline() const noexcept { return deadline_; }
  /// Whether the calling thread waits for the answer.
  bool blocking() const noexcept { return blocking_; }

  /// True for exactly one caller, who may then fill out() and must finish().
  bool claim() noexcept { return !claimed_.exchange(true, std::memory_order_acq_rel); }

  /// Ends the call; only after a successful claim(). A null `error` means that out() is filled.
  void finish(std::exception_ptr error = nullptr);

  /// claim() and finish(error); false where somebody else was first.
  bool fail(std::exception_ptr error);

  bool finished() const;

  /// Blocks until finished; the lane guarantees that this happens at the latest at the deadline.
  void wait() const;

  /// Set by the lane: how long wait() looks for the end before it sleeps.
  void set_spin(std::chrono::microseconds budget) noexcept { spin_ = budget; }

  /// The error that ended the call, handed over (not copied: an exception shared by two threads
  /// would be released by whichever lets go last); null after a success. Only once finished.
  std::exception_ptr take_error();

  /// Runs `action`; what it throws ends the call.
  template <class Action>
  void attempt(Action&& action) {
    std::exception_ptr error;
    try {
      action();
    } catch (...) {
      error = std::current_exception();
    }
    if (error) fail(std::move(error));
  }

  /// Runs `action` once the call is finished, at once where it is already; on the thread that
  /// finishes it, which may be a vendor's: it must neither block nor run user code. One action at
  /// most.
  void on_finished(Action action);

  /// Set by the lane: what tells the server that nobody waits any more.
  void set_canceller(Action canceller);

  /// Ends the call as Cancelled, unless it has ended, and tells the server.
  void cancel();

  /// The same with another error.
  void abandon(std::exception_ptr error);

 private:
  const OperationInfo& operation_;
  void* const out_;
  const Instant deadline_;
  const bool blocking_;
  std::atomic<std::chrono::microseconds> spin_{std::chrono::microseconds(0)};
  std::atomic<bool> claimed_{false};
  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  std::atomic<bool> finished_{false};  // written under the lock
  std::exception_ptr error_;
  Action action_;
  Action canceller_;
};

/// When a call began, and until when its answer is of use.
struct CallTime {
  Instant begin;
  Instant deadline;
};

/// How a proxy hands over a request and gets its reply: within the process as typed pointers, or
/// over a network as bytes. Thread-safe.
class Channel {
 public:
  virtual ~Channel() = default;

  /// Sends the request whose in struct is `in`, which need live only until this returns. Never
  /// throws: whatever fails finishes `call`. A oneway call is finished when the request is handed
  /// over.
  virtual void start(const std::shared_ptr<PendingCall>& call, const void* in) = 0;

  /// The blocking call: fills `out`, the operation's out struct, or throws what ended the call.
  /// What a lane does not do on the calling thread it does by start(). Not for streams.
  virtual void call(const OperationInfo& operation, const void* in, void* out,
                    const CallTime& time);

  virtual Clock& clock() const noexcept = 0;

  /// Where continuations of asynchronous calls run.
  virtual Executor& continuations() const noexcept = 0;

  /// Who is at the other end, for messages: `AE_navigator/IPlanner of Navigator (uav-1)`.
  virtual std::string peer() const = 0;

  /// Whether calls can be made: neither disconnected nor has the provider been lost.
  virtual bool connected() const = 0;

  /// Ends the connection: pending calls end as Cancelled, later ones as Unavailable. Twice is no
  /// error.
  virtual void disconnect() = 0;

  /// Notes that one of the connection's ends is gone: pending calls end as Disconnected, later ones
  /// as Unavailable.
  virtual void lose(const std::string& how) = 0;
};

}  // namespace skein
