#pragma once

#include <algorithm>
#include <atomic>
#include <exception>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "skein/core/clock.hpp"
#include "skein/core/guid.hpp"

namespace skein {

/// What a Head keeps for one connected client, from `open` to `disconnect`. Only the floor that
/// made it knows what is inside.
class Session {
 public:
  virtual ~Session() = default;
};

/// The call that the current thread is executing: who asked, until when an answer is of use, and
/// through whom the request came. An implementation reads it by CallContext::current(); calls that
/// it makes in turn inherit the deadline and the chain by themselves.
class CallContext {
 public:
  /// Who waits for the call's answer: `outer`, the call on whose thread it runs, and who waits for
  /// that, or else those whom the request named; and the service itself, by its `strand`.
  struct Waiting {
    const CallContext* outer = nullptr;
    std::span<const Guid> named{};
    Guid strand{};
  };

  /// Sends the call's outcome: the out struct, or what was thrown.
  using Respond = std::function<void(const void* out, std::exception_ptr error)>;

  /// What the arguments point to outlives the context. `respond` is null or empty where the caller
  /// waits on this thread.
  CallContext(const Clock& clock, Instant deadline, Guid caller, const Waiting& waiting,
              Session* session, const std::atomic<bool>* cancelled,
              const Respond* respond = nullptr)
      : clock_(clock),
        deadline_(deadline),
        caller_(caller),
        waiting_(waiting),
        session_(session),
        cancelled_(cancelled),
        respond_(respond) {}

  /// The innermost call on this thread, or nullptr outside of any.
  static const CallContext* current() noexcept;

  Instant deadline() const noexcept { return deadline_; }

  /// Time left until the deadline; zero when it has passed.
  Duration remaining() const { return std::max(Duration::zero(), deadline_ - clock_.now()); }

  /// Whether nobody waits for the answer any more: cancelled, client gone, or deadline passed.
  bool cancelled() const {
    return (cancelled_ && cancelled_->load(std::memory_order_relaxed)) || clock_.now() >= deadline_;
  }

  /// Answers the call in the place of its thread, which hangs and has been written off (Worker), so
  /// that it never will. Once, from another thread.
  void answer_instead(std::exception_ptr error) const {
    if (respond_ && *respond_) (*respond_)(nullptr, std::move(error));
  }

  /// Identity of the client's connection; nil for a caller in the same process.
  const Guid& caller() const noexcept { return caller_; }

  /// The services that wait for this call's answer, outermost first.
  std::vector<Guid> chain() const;

  /// How often `strand` is in the chain.
  std::size_t waits(const Guid& strand) const noexcept;

  /// What the Head made at `open`; nullptr for a service without a Head.
  Session* session() const noexcept { return session_; }

 private:
  const Clock& clock_;
  Instant deadline_;
  Guid caller_;
  Waiting waiting_;
  Session* session_;
  const std::atomic<bool>* cancelled_;
  const Respond* respond_;
};

/// Makes a context the current one for as long as the scope lasts.
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
