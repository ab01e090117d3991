#pragma once

#include <exception>
#include <memory>

#include "skein/call_context.hpp"
#include "skein/detail/action.hpp"

namespace skein {

/// How a call that is answered later waits at its provider: the `out` of Servant::dispatch() for a
/// servant that answers later. It ends exactly once. If it goes without an answer, it ends as
/// Internal, with a text that says so. Thread-safe.
class PendingReply : public std::enable_shared_from_this<PendingReply> {
 public:
  virtual ~PendingReply() = default;

  /// The out struct.
  virtual void* out() noexcept = 0;

  /// Returns true to exactly one caller, which may then fill out() and must call finish(). To all
  /// others it returns false, and the log says that their answer came too late.
  virtual bool claim() = 0;

  /// Ends the call; only after a successful claim(). A null `error` means that out() is filled.
  virtual void finish(std::exception_ptr error) = 0;

  /// The call: whether it was cancelled, and when it has to end.
  virtual const CallContext& call() const noexcept = 0;

  /// Runs `action` when the call is cancelled; at once if it already is.
  virtual void on_cancel(Action action) = 0;
};

}  // namespace skein
