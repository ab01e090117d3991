#pragma once

#if __cplusplus < 202002L
#include "skein/detail/version.hpp"  // which says so: <coroutine> would say less
#endif

#include <coroutine>
#include <exception>
#include <functional>
#include <memory>
#include <type_traits>
#include <utility>

#include "skein/call_context.hpp"
#include "skein/detail/call_memory.hpp"
#include "skein/detail/channel.hpp"
#include "skein/error.hpp"
#include "skein/stream.hpp"

namespace skein {

/// An asynchronous call and its result. Move-only; destroying it cancels the call. Use each call
/// once: by get(), then() or co_await; a call that was used or moved from throws InvalidArgument.
template <class Result>
class [[nodiscard]] Call {
  using Stored = std::conditional_t<std::is_void_v<Result>, char, Result>;

 public:
  /// `result` points into the out struct of `pending` (nullptr for void). Used by generated code.
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

  /// Whether the call has ended.
  bool ready() const { return pending().finished(); }

  /// Waits until the call ends, at the latest at its deadline. Returns the result or throws the
  /// error that ended the call.
  Result get() {
    pending().wait();
    const auto ended = std::move(pending_);
    return take(*ended);
  }

  /// Cancels the call, unless it has ended, and notifies the server. get() then throws Cancelled.
  void cancel() { pending().cancel(); }

  /// Runs `action` when the call is finished; at once if it already is. It runs on the thread that
  /// finishes the call, possibly a vendor's, so it must neither block nor run user code. At most
  /// one action; do not combine it with then() or co_await.
  void notify(Action action) { pending().on_finished(std::move(action)); }

  /// A function that does what cancel() does. Any thread may call it at any time; it has no effect
  /// after the call has ended.
  std::function<void()> canceller() const {
    return [weak = std::weak_ptr(pending_)] {
      if (const auto pending = weak.lock()) pending->cancel();
    };
  }

  /// Runs `continuation(Call<Result>)` with this finished call on the connection's continuation
  /// executor; after the entity has ended, on the thread that finishes the call. It always runs, as
  /// does a coroutine that awaits the call. What it throws is logged, and goes nowhere else.
  template <class Continuation>
  void then(Continuation continuation) && {
    const auto pending = this->pending().shared_from_this();
    auto shared = make_shared_in_call_memory<Call>(std::move(*this));
    auto run = [shared, continuation = std::move(continuation)]() mutable {
      try {
        continuation(std::move(*shared));
      } catch (...) {
        report_thrown_by_continuation(std::current_exception());
      }
    };
    Executor& executor = shared->channel_->continuations();
    pending->on_finished(
        [&executor, run = std::move(run)]() mutable { executor.post_or_run(std::move(run)); });
  }

  /// For those who forget that then() takes the call over.
  template <class Continuation>
  void then(Continuation&&) const& {
    static_assert(
        std::is_void_v<Continuation>,
        "then() takes the call over: write std::move(call).then(...) where it has a name");
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
  PendingCall& pending() const {
    if (pending_) return *pending_;
    throw InvalidArgument(
        "this call was used before, by get(), then() or co_await, or moved from; use each call "
        "once");
  }

  Result take(PendingCall& pending) const {
    if (auto error = pending.take_error()) std::rethrow_exception(std::move(error));
    if constexpr (!std::is_void_v<Result>) return std::move(*result_);
  }

  std::shared_ptr<PendingCall> pending_;
  std::shared_ptr<Channel> channel_;
  Stored* result_;
};

/// Base of generated proxies: a connection and the timeout of each call through it.
class ProxyBase {
 public:
  /// Default timeout of a call. Every call has a deadline.
  static constexpr Duration kDefaultTimeout = std::chrono::seconds(5);

  /// The connection, shared with copies of this proxy.
  const std::shared_ptr<Channel>& channel() const noexcept { return channel_; }

  /// Ends the connection, also for copies of this proxy: pending calls end as Cancelled, later ones
  /// as Unavailable.
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

  /// Blocking call; returns the out struct or throws.
  template <class Out, class In>
  Out call(const OperationInfo& operation, const In& in) const {
    Out out{};
    channel_->call(operation, &in, &out, call_time());
    return out;
  }

  /// Asynchronous call; `select(out)` returns a pointer to the result in the out struct.
  template <class Result, class Out, class In, class Select>
  Call<Result> async_call(const OperationInfo& operation, const In& in, Select select) const {
    auto pending = make_shared_in_call_memory<TypedCall<Out>>(operation, call_time().deadline);
    auto* const result = select(pending->value);
    channel_->start(pending, &in);
    return Call<Result>(std::move(pending), channel_, result);
  }

  /// Call of an operation that returns a stream of results.
  template <class Result, class Out, class In>
  Stream<Result> stream(const OperationInfo& operation, const In& in) const {
    auto pending = std::make_shared<PendingStream>(operation, call_time().deadline);
    channel_->start(pending, &in);
    return Stream<Result>(std::move(pending), channel_, [](void* out) -> Result {
      return std::move(static_cast<Out*>(out)->return_);
    });
  }

  /// Throws InvalidArgument for less than 0.
  void set_timeout(Duration timeout);

  /// A nested call never outlives the deadline of the outer call.
  CallTime call_time() const {
    const Instant begin = channel_->clock().now();
    const CallContext* outer = CallContext::current();
    return {begin, outer ? std::min(begin + timeout_, outer->deadline()) : begin + timeout_};
  }

 private:
  std::shared_ptr<Channel> channel_;
  Duration timeout_;
};

}  // namespace skein
