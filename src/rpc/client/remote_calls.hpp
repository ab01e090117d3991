#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <utility>

#include "caller_answers.hpp"
#include "pending_calls.hpp"
#include "refused_replies.hpp"
#include "request_path.hpp"
#include "rpc/wire/wire.hpp"
#include "skein/executor.hpp"
#include "skein/stream.hpp"

namespace skein::rpc {

/// The calls of a connection: each ends by its reply, at its deadline, or with the connection.
/// Thread-safe.
class RemoteCalls : public std::enable_shared_from_this<RemoteCalls> {
 public:
  struct Parts {
    std::shared_ptr<Clock> clock;  ///< First: `path` uses it until its end.
    std::shared_ptr<RequestPath> path;
    std::shared_ptr<RefusedReplies> refused;
    Executor& control;
    std::string peer;                ///< For messages.
    std::chrono::microseconds spin;  ///< How long a thread that waits polls before it sleeps.
    std::size_t most;                ///< Calls that may wait for their answers.
    std::function<void()> on_idle;   ///< Called when the last call has ended.
  };

  /// `control` exists until fail_all() has returned, which must be called.
  static std::shared_ptr<RemoteCalls> make(Parts parts);

  PendingCalls& pending() noexcept { return *pending_; }
  /// Call it before start(). Callers then take their own answers through `answers`, which this
  /// object does not keep alive.
  void set_answers(const std::shared_ptr<CallerAnswers>& answers) { answers_ = answers; }
  /// The port's thread takes what comes, until a caller waits again.
  void hand_over() const;

  /// Sends a call's request. Returns false, and leaves the call as it was, if none is taken any
  /// more. Throws Overloaded if too many calls wait already, and NotSent; all other errors end the
  /// call.
  bool start(const std::shared_ptr<PendingCall>& call, const void* in);
  void on_reply(std::span<const std::byte> message, const wire::ReplyHead& head);
  /// A reply that cannot be read, except perhaps for the call that it answers.
  void on_unreadable(std::span<const std::byte> message, const std::exception& why);
  /// Ends all calls, and takes none from now on.
  void fail_all(const std::function<std::exception_ptr(const OperationInfo&)>& make_error);

 private:
  explicit RemoteCalls(Parts parts) : parts_(std::move(parts)) {}

  std::shared_ptr<PendingCall> remove(std::uint64_t number,
                                      PendingCalls::Keep keep = PendingCalls::Keep::Nothing);
  void finish(PendingCall& call, std::uint64_t number, std::exception_ptr error) const;
  void read_part(std::uint64_t number, PendingStream& stream, std::span<const std::byte> message,
                 const wire::ReplyHead& head);
  void expire(std::uint64_t number);
  void abandon(std::uint64_t number);
  void tell_server(std::uint64_t number);
  void grant(std::uint64_t number, std::uint32_t count) const;

  const Parts parts_;
  std::shared_ptr<PendingCalls> pending_;
  std::weak_ptr<CallerAnswers> answers_;  // fixed once there are calls
  std::atomic<std::uint64_t> told_{0};    // how often the server was told that a call has ended
  std::mutex mutex_;
  bool failed_ = false;
};

}  // namespace skein::rpc
