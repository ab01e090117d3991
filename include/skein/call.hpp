#pragma once

#if __cplusplus < 202002L
#include "skein/detail/version.hpp"  // which says so: <coroutine> would say less
#endif

#include <concepts>
#include <coroutine>
#include <exception>
#include <functional>
#include <memory>
#include <type_traits>
#include <utility>

#include "skein/call_context.hpp"
#include "skein/detail/call_memory.hpp"
#include "skein/detail/channel.hpp"
#include "skein/detail/pending_reply.hpp"
#include "skein/error.hpp"
#include "skein/stream.hpp"

namespace skein {

/// An asynchronous call and its result. Move-only; destroying it cancels the call. Use each call
/// once: by get(), then() or co_await; a call that was used or moved from throws InvalidArgument.
///
/// ```cpp
/// auto first = surveyor.async_minutes(kField);  // returns at once
/// auto second = surveyor.async_minutes(kField);
/// const double total_minutes = first.get() + second.get();
/// ```
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
  /// finishes the call, possibly one of the library's or one that waits for another call, so it
  /// must neither block nor run user code. At most one action; do not combine it with then() or
  /// co_await.
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

/// The answer that an implementation owes. It may be given on any thread, also after the operation
/// has returned: until then the call occupies no thread. Copies belong to the same call, whose
/// first answer counts. The arguments of the operation live as long as a copy.
///
/// If the last copy goes without an answer, the caller gets Internal, with a text that says so.
/// When its service is withdrawn, a call that has no answer ends as Disconnected.
///
/// The answer leaves on the thread that gives it, as that of an ordinary implementation does. T is
/// what an asynchronous call of the operation returns: its result, or `I_f_Out` where it has out
/// parameters. Thread-safe. A reply that was moved from throws InvalidArgument.
template <class T>
class Reply {
  using Stored = std::conditional_t<std::is_void_v<T>, char, T>;

 public:
  /// `result` points into the out struct of `pending` (nullptr for void). Used by generated code.
  explicit Reply(std::shared_ptr<PendingReply> pending, Stored* result = nullptr)
      : pending_(std::move(pending)), result_(result) {}

  /// Answers with the result. Returns false, has no effect, and logs a warning, if the call was
  /// answered before or its service was withdrawn. If only the caller has given up, the answer
  /// just goes nowhere.
  bool answer(Stored result) const requires(!std::is_void_v<T>) {
    if (!pending().claim()) return false;
    *result_ = std::move(result);
    pending().finish(nullptr);
    return true;
  }
  bool answer() const requires std::is_void_v<T> {
    if (!pending().claim()) return false;
    pending().finish(nullptr);
    return true;
  }

  /// Answers with an exception: the caller gets what it would get if an ordinary implementation
  /// threw it. Otherwise as answer().
  bool fail(std::exception_ptr error) const {
    if (!pending().claim()) return false;
    pending().finish(std::move(error));
    return true;
  }
  template <std::derived_from<std::exception> Exception>
  bool fail(Exception error) const {
    return fail(std::make_exception_ptr(std::move(error)));
  }

  /// Answers with what `function` returns or throws: `reply.answer_with([&] { return call.get();
  /// })` passes on how another call has ended.
  template <std::invocable Function>
  bool answer_with(Function&& function) const {
    try {
      if constexpr (std::is_void_v<T>) {
        function();
        return answer();
      } else {
        return answer(function());
      }
    } catch (...) {
      return fail(std::current_exception());
    }
  }

  /// The call that is to be answered; valid as long as a copy of the reply. Under `CallContextScope
  /// scope(reply.call())`, calls made on another thread inherit its deadline.
  const CallContext& call() const { return pending().call(); }

  /// Runs `action` once nobody waits for the answer any more: the caller has cancelled, its
  /// deadline has passed there, it is gone, or the service is withdrawn. At once if that is so
  /// already; not after the answer. `reply.on_cancel(call.canceller())` passes it on to another
  /// call. It runs on the thread that notices, possibly one of the library's, so it must neither
  /// block nor run user code. At most one action.
  void on_cancel(Action action) const { pending().on_cancel(std::move(action)); }

 private:
  PendingReply& pending() const {
    if (pending_) return *pending_;
    throw InvalidArgument("this reply was moved from; use the object that it was moved to");
  }

  std::shared_ptr<PendingReply> pending_;
  Stored* result_;
};

/// Base of generated proxies: a connection and the timeout of each call through it. A proxy that
/// was made without a connection, or moved from, throws InvalidArgument when it is called.
class ProxyBase {
 public:
  /// Default timeout of a call. Every call has a deadline.
  static constexpr Duration kDefaultTimeout = std::chrono::seconds(5);

  /// The connection, shared with copies of this proxy.
  const std::shared_ptr<Channel>& channel() const noexcept { return channel_; }

  /// Ends the connection, also for copies of this proxy: pending calls end as Cancelled, later ones
  /// as Unavailable. Has no effect if there is none.
  void disconnect() {
    if (channel_) channel_->disconnect();
  }

 protected:
  ProxyBase() = default;
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
    connection().call(operation, &in, &out, call_time());
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
    const Instant begin = connection().clock().now();
    const Instant deadline = saturating_sum(begin, timeout_);
    const CallContext* outer = CallContext::current();
    return {begin, outer ? std::min(deadline, outer->deadline()) : deadline};
  }

  /// Throws InvalidArgument if there is none.
  Channel& connection() const {
    if (!channel_) throw_no_connection();
    return *channel_;
  }

 private:
  [[noreturn]] static void throw_no_connection();

  std::shared_ptr<Channel> channel_;
  Duration timeout_ = kDefaultTimeout;
};

}  // namespace skein
