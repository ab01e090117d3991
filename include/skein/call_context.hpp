#pragma once

#include <algorithm>
#include <atomic>
#include <string>
#include <vector>

#include "skein/clock.hpp"
#include "skein/detail/waiting_services.hpp"
#include "skein/guid.hpp"

namespace skein {

/// State that a Head keeps for one connected client, from `open` to `disconnect`. Opaque outside
/// the layer that makes it.
class Session {
 public:
  virtual ~Session() = default;
};

/// The call that the current thread executes: its caller, its deadline, and the services that wait
/// for it. An implementation gets it from CallContext::current() until it returns, or from
/// Reply::call(). Calls that it makes on this thread inherit the deadline; blocking ones also
/// inherit the chain.
class CallContext {
 public:
  /// The objects that the arguments refer to must outlive the context.
  CallContext(const Clock& clock, Instant deadline, Guid caller, const WaitingServices& waiting,
              Session* session, const std::atomic<bool>* cancelled)
      : clock_(clock),
        deadline_(deadline),
        caller_(caller),
        waiting_(waiting),
        session_(session),
        cancelled_(cancelled) {}

  /// The innermost call on this thread; nullptr outside a call.
  static const CallContext* current() noexcept;

  Instant deadline() const noexcept { return deadline_; }

  /// Time left until the deadline; zero after it.
  Duration remaining() const { return std::max(Duration::zero(), deadline_ - clock_.now()); }

  /// Whether nobody waits for the answer any more: the call was cancelled, its client is gone, the
  /// service is being withdrawn, or the deadline has passed. Also true if this holds for the outer
  /// call.
  bool cancelled() const {
    return (cancelled_ && cancelled_->load(std::memory_order_relaxed)) ||
           clock_.now() >= deadline_ || (waiting_.outer && waiting_.outer->cancelled());
  }

  /// Identity of the client's connection; nil for a caller in the same process.
  const Guid& caller() const noexcept { return caller_; }

  /// The services that wait for this call's answer, outermost first; the last is this one, if its
  /// thread waits, too.
  std::vector<Guid> chain() const;

  /// How often `strand` occurs in the chain.
  std::size_t waits(const Guid& strand) const noexcept;

  /// The session that the Head made at `open`; nullptr for a service without a Head.
  Session* session() const noexcept { return session_; }

 private:
  const Clock& clock_;
  Instant deadline_;
  Guid caller_;
  WaitingServices waiting_;
  Session* session_;
  const std::atomic<bool>* cancelled_;
};

/// Makes a context the current one while the scope exists.
class CallContextScope {
 public:
  explicit CallContextScope(const CallContext& context) noexcept;
  ~CallContextScope();
  CallContextScope(const CallContextScope&) = delete;
  CallContextScope& operator=(const CallContextScope&) = delete;

 private:
  const CallContext* outer_;
};

}  // namespace skein
