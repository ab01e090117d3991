#pragma once

#include <atomic>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "rpc/service/outgoing_stream.hpp"
#include "skein/call_context.hpp"
#include "skein/clock.hpp"
#include "skein/detail/action.hpp"
#include "skein/detail/operation.hpp"
#include "skein/error.hpp"
#include "skein/guid.hpp"

namespace skein::rpc {

/// One request as the provider sees it, from whichever transport. It owns its arguments.
struct Invocation {
  const OperationInfo* operation = nullptr;
  /// Keeps the memory that parameters refer to, if they were not copied.
  std::shared_ptr<const void> lent;
  /// The in struct; freed by the operation's own TypeSupport.
  std::unique_ptr<void, void (*)(void*)> in{nullptr, [](void*) {}};
  Guid caller;
  Guid connection;           ///< Waits in line with this connection's other invocations.
  std::uint64_t number = 0;  ///< The connection's own count.
  Instant arrived;
  Instant begun;  ///< When the implementation was called.
  Instant ended;  ///< When the implementation had returned or thrown.
  Instant deadline;
  std::vector<Guid> chain;  ///< The services that wait for the answer, as the request says.
  /// The call on this thread that makes this one; null if there is none.
  const CallContext* outer = nullptr;
  std::shared_ptr<Session> session;
  std::atomic<bool> cancelled{false};
  /// Takes the results if the operation is a stream.
  std::shared_ptr<OutgoingStream> stream;
  /// Called once, on the thread that ends it: the out struct, or the exception; neither at
  /// the end of a stream.
  std::function<void(const void* out, std::exception_ptr error)> respond;
  std::shared_ptr<Invocation> next;  ///< The FairQueue's.

  /// Nobody waits for the answer any more: the implementation hears so (CallContext, StreamSink,
  /// Reply). Not under a lock.
  void cancel() {
    stop(ErrorCode::Cancelled, "its caller waits no longer");
    tell_cancelled();
  }
  /// Without the action of on_cancel().
  void stop(ErrorCode code, const std::string& why) {
    cancelled = true;
    if (stream) stream->stop(code, why);
  }

  /// Runs `action` when the call is cancelled; at once if it already is. An empty one forgets it.
  void on_cancel(Action action);
  void tell_cancelled();

 private:
  std::mutex action_mutex_;
  Action action_;
};

inline void Invocation::on_cancel(Action action) {
  {
    std::lock_guard lock(action_mutex_);
    if (!cancelled) {
      action_ = std::move(action);
      return;
    }
  }
  if (action) action();
}

inline void Invocation::tell_cancelled() {
  Action action;
  {
    std::lock_guard lock(action_mutex_);
    action = std::move(action_);
  }
  if (action) action();
}

}  // namespace skein::rpc
