#pragma once

#include <atomic>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "skein/clock.hpp"
#include "skein/detail/action.hpp"
#include "skein/detail/operation.hpp"
#include "skein/error.hpp"
#include "skein/executor.hpp"
#include "skein/guid.hpp"

namespace skein {

/// Logs what a continuation of Call::then() threw.
void report_thrown_by_continuation(const std::exception_ptr& thrown) noexcept;

/// Where the answers to a connection's calls come in, for a thread that waits for one of them: it
/// may take them itself, which saves a wake-up and a change of threads. Thread-safe.
class Answers {
 public:
  virtual ~Answers() = default;
  /// Takes answers, other calls' too, until `finished`, which wake() makes it look at. Returns
  /// earlier where another thread takes them.
  virtual void take_until(const std::atomic<bool>& finished) = 0;
  virtual void wake() = 0;
  /// A call begins; its thread waits for the answer at once if it is `blocking`.
  virtual void begin(bool blocking) = 0;
  /// As many as have begun: it has ended.
  virtual void end() = 0;
  /// A call's end is awaited otherwise: until as many leave(), a thread that never waits for one
  /// takes them, and nobody who begins to wait does.
  virtual void attend() = 0;
  virtual void leave() = 0;
};

/// One call in progress. It is finished exactly once, by a reply or by an error, whichever claims
/// it first. Shared by the caller and the transport that carries it.
class PendingCall : public std::enable_shared_from_this<PendingCall> {
 public:
  /// `out` is the operation's out struct; it must live until the call is finished.
  PendingCall(const OperationInfo& operation, void* out, Instant deadline, bool blocking)
      : operation_(operation), out_(out), deadline_(deadline), blocking_(blocking) {}
  virtual ~PendingCall() = default;

  const OperationInfo& operation() const noexcept { return operation_; }
  void* out() const noexcept { return out_; }
  Instant deadline() const noexcept { return deadline_; }
  /// Whether the calling thread waits for the answer.
  bool blocking() const noexcept { return blocking_; }

  /// Returns true to exactly one caller, which may then fill out() and must call finish().
  bool claim() noexcept { return !claimed_.exchange(true, std::memory_order_acq_rel); }
  bool claimed() const noexcept { return claimed_.load(std::memory_order_acquire); }

  /// Ends the call; only after a successful claim(). A null `error` means that out() is filled.
  void finish(std::exception_ptr error = nullptr);

  /// claim() and finish(error); false if another caller was first.
  bool fail(std::exception_ptr error);

  bool finished() const;

  /// Set by the transport before the request leaves; null if it did not leave.
  void set_answers(const std::shared_ptr<Answers>& answers);

  /// Blocks until finished. The transport guarantees this by the deadline.
  void wait() const;

  /// Set by the transport: how long wait() polls for the end before it sleeps.
  void set_spin(std::chrono::microseconds budget) noexcept { spin_ = budget; }

  /// Moves out the error that ended the call; null after a success. Only once finished. It is not
  /// copied: otherwise either of two threads might be the one that releases the exception.
  std::exception_ptr take_error();

  /// Runs `action`; an exception from it ends the call.
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

  /// Runs `action` when the call is finished; at once if it already is. It runs on the thread that
  /// finishes the call, possibly a vendor's, so it must neither block nor run user code. At most
  /// one action.
  void on_finished(Action action);

  /// Set by the transport: notifies the server of a cancelled call.
  void set_canceller(Action canceller);

  /// Ends the call as Cancelled, unless it has ended, and notifies the server.
  void cancel();

  /// As cancel(), with another error.
  void abandon(std::exception_ptr error);

 private:
  void attend() const;

  const OperationInfo& operation_;
  void* const out_;
  const Instant deadline_;
  const bool blocking_;
  std::atomic<std::chrono::microseconds> spin_{std::chrono::microseconds(0)};
  std::atomic<bool> claimed_{false};
  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  std::atomic<bool> finished_{false};  // written under the lock
  std::shared_ptr<Answers> answers_;   // null: no thread that waits can take them
  mutable bool attended_ = false;
  mutable bool taken_here_ = false;  // by a thread that waits
  std::exception_ptr error_;
  Action action_;
  Action canceller_;
};

/// An open connection to one provider, for those who look at it.
struct ConnectionInfo {
  std::string service;      ///< Canonical interface name.
  Guid provider;            ///< Nil: a foreign server.
  std::string transport;    ///< "process", "shared memory" or "DDS", the fastest first.
  std::string not_faster;   ///< Why none of the faster ones; empty where there is none.
  std::size_t pending = 0;  ///< Calls that wait for their answer.
  std::uint64_t calls = 0;  ///< That were begun.
};

/// When a call began, and its deadline.
struct CallTime {
  Instant begin;
  Instant deadline;
};

/// Unavailable, as the connection has ended before anything of the call was sent: it may be made on
/// another connection, whatever it does.
class NotSent : public Unavailable {
 public:
  using Unavailable::Unavailable;
};

/// Carries a proxy's requests and replies: within the process as typed pointers, over a network as
/// bytes. Thread-safe.
class Channel {
 public:
  virtual ~Channel() = default;

  /// Sends the request with the in struct `in`, which need not outlive this function. Never throws:
  /// an error finishes `call`. A oneway call is finished when the request has been sent.
  virtual void start(const std::shared_ptr<PendingCall>& call, const void* in) = 0;

  /// As start(), but throws NotSent, with the call as it was, where the connection has ended.
  virtual void start_here(const std::shared_ptr<PendingCall>& call, const void* in) {
    start(call, in);
  }

  /// Blocking call: fills `out`, the operation's out struct, or throws the error that ended the
  /// call; NotSent as start_here(), which it uses by default. Not for streams.
  virtual void call(const OperationInfo& operation, const void* in, void* out,
                    const CallTime& time);

  virtual Clock& clock() const noexcept = 0;

  /// Where continuations of asynchronous calls run.
  virtual Executor& continuations() const noexcept = 0;

  /// Name of the other end, for messages: `AE_navigator::IPlanner of Navigator (uav-1)`.
  virtual std::string peer() const = 0;

  /// Nothing for what consists of other channels.
  virtual std::optional<ConnectionInfo> info() const { return std::nullopt; }

  /// Whether calls can be made: not disconnected, and the provider is not lost.
  virtual bool connected() const = 0;

  /// Ends the connection: pending calls end as Cancelled, later ones as Unavailable. Calling it
  /// twice is no error.
  virtual void disconnect() = 0;

  /// Notes that one end of the connection is gone: pending calls end as Disconnected, later ones as
  /// Unavailable.
  virtual void lose(const std::string& how) = 0;
};

}  // namespace skein
