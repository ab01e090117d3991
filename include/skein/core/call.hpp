#pragma once

#include <coroutine>
#include <functional>
#include <memory>
#include <type_traits>
#include <utility>

#include "skein/core/call_context.hpp"
#include "skein/core/call_memory.hpp"
#include "skein/core/channel.hpp"
#include "skein/core/error.hpp"
#include "skein/core/stream.hpp"

namespace skein {

/// An asynchronous call and its result. Move-only; dropping it cancels the call. Each call is used
/// once: by get(), by then(), or by co_await.
template <class Result>
class Call {
  using Stored = std::conditional_t<std::is_void_v<Result>, char, Result>;

 public:
  /// `result` points into `pending`'s out struct (nullptr for void). Used by generated code.
  Call(std::shared_ptr<PendingCall> pending, std::shared_ptr<Channel> channel, Stored* result)
      : pending_(std::move(pending)), channel_(std::move(channel)), result_(result) {}
  Call(Call&&) noexcept = default;
  Call& operator=(Call&& other) noexcept {
    if (this != &other) {
      if (pending_) pending_->cancel();
      pending_ = std::move(other.pending_);
      channel_ = std::move(other.channel_);
      result_ = other.result_;
    }
    return *this;
  }
  ~Call() {
    if (pending_) pending_->cancel();
  }

  bool ready() const { return pending_->finished(); }

  /// Waits for the end (the deadline at the latest); returns the result or throws what ended the
  /// call.
  Result get() {
    const auto pending = std::move(pending_);
    pending->wait();
    return take(*pending);
  }

  /// Tells the server that nobody waits any more; a later get() throws Cancelled.
  void cancel() { pending_->cancel(); }

  /// Runs `action` once the call is finished, on the thread that finishes it, which may be a
  /// vendor's: it must neither block nor run user code. One action at most, and no then() or
  /// co_await beside it.
  void notify(Action action) { pending_->on_finished(std::move(action)); }

  /// cancel() for others, who may ask for it at any time and on any thread; without effect once the
  /// call has ended.
  std::function<void()> canceller() const {
    return [weak = std::weak_ptr(pending_)] {
      if (const auto pending = weak.lock()) pending->cancel();
    };
  }

  /// Runs `continuation(Call<Result>)` with this call, then finished, on the connection's executor;
  /// once the entity has ended, on the thread that notices. It runs in any case, and so does what
  /// co_awaits.
  template <class Continuation>
  void then(Continuation continuation) && {
    auto pending = pending_;
    auto shared = make_shared_in_call_memory<Call>(std::move(*this));
    auto run = [shared, continuation = std::move(continuation)]() mutable {
      continuation(std::move(*shared));
    };
    Executor& executor = shared->channel_->continuations();
    pending->on_finished(
        [&executor, run = std::move(run)]() mutable { executor.post_or_run(std::move(run)); });
  }

  auto operator co_await() && {
    struct Awaiter {
      Call call;
      bool await_ready() const { return call.ready(); }
      void await_suspend(std::coroutine_handle<> waiting) {
        Executor& executor = call.channel_->continuations();
        call.pending_->on_finished(
            [&executor, waiting] { executor.post_or_run([waiting] { waiting.resume(); }); });
      }
      Result await_resume() { return call.get(); }
    };
    return Awaiter{std::move(*this)};
  }

 private:
  Result take(PendingCall& pending) const {
    if (auto error = pending.take_error()) std::rethrow_exception(std::move(error));
    if constexpr (!std::is_void_v<Result>) return std::move(*result_);
  }

  std::shared_ptr<PendingCall> pending_;
  std::shared_ptr<Channel> channel_;
  Stored* result_;
};

/// What generated proxies are made of: a connection and the time limit of each call through it.
class ProxyBase {
 public:
  /// The default limit of a call. There is no call without a deadline.
  static constexpr Duration kDefaultTimeout = std::chrono::seconds(5);

  /// The connection that this proxy and its copies share.
  const std::shared_ptr<Channel>& channel() const noexcept { return channel_; }

  /// Ends the connection, and the Head's session with it.
  void disconnect() { channel_->disconnect(); }

 protected:
  ProxyBase(std::shared_ptr<Channel> channel, Duration timeout)
      : channel_(std::move(channel)), timeout_(timeout) {}

  template <class Out>
  struct TypedCall final : PendingCall {
    TypedCall(const OperationInfo& operation, Instant deadline)
        : PendingCall(operation, &value, deadline, false) {}
    Out value{};
  };

  /// The blocking call; returns the out struct or throws.
  template <class Out, class In>
  Out call(const OperationInfo& operation, const In& in) const {
    Out out{};
    channel_->call(operation, &in, &out, call_time());
    return out;
  }

  /// The asynchronous call; `select(out)` names the part of the out struct that is the result.
  template <class Result, class Out, class In, class Select>
  Call<Result> async_call(const OperationInfo& operation, const In& in, Select select) const {
    auto pending = make_shared_in_call_memory<TypedCall<Out>>(operation, call_time().deadline);
    auto* const result = select(pending->value);
    channel_->start(pending, &in);
    return Call<Result>(std::move(pending), channel_, result);
  }

  /// The call of an operation that is a stream of results.
  template <class Result, class Out, class In>
  Stream<Result> stream(const OperationInfo& operation, const In& in) const {
    auto pending = std::make_shared<PendingStream>(operation, call_time().deadline);
    channel_->start(pending, &in);
    return Stream<Result>(std::move(pending), channel_, [](void* out) -> Result {
      return std::move(static_cast<Out*>(out)->return_);
    });
  }

  void set_timeout(Duration timeout) { timeout_ = timeout; }

 private:
  /// A call made while executing another never outlives the outer one's deadline.
  CallTime call_time() const {
    const Instant begin = channel_->clock().now();
    const CallContext* outer = CallContext::current();
    return {begin, outer ? std::min(begin + timeout_, outer->deadline()) : begin + timeout_};
  }

  std::shared_ptr<Channel> channel_;
  Duration timeout_;
};

}  // namespace skein
