#pragma once

#if __cplusplus < 202002L
#include "skein/detail/version.hpp"  // which says so: <coroutine> would say less
#endif

#include <coroutine>
#include <cstddef>
#include <functional>
#include <iterator>
#include <memory>
#include <optional>
#include <utility>

#include "skein/detail/pending_stream.hpp"
#include "skein/error.hpp"

namespace skein {

/// The results of an operation that `@stream` declares, as they arrive. Move-only;
/// destroying it cancels the operation. One thread at a time. The deadline of the call applies to
/// the whole stream. A stream that was moved from throws InvalidArgument.
///
/// A slow reader slows the provider: the provider may be 8 results ahead (PendingStream::kWindow),
/// then it waits. If nothing is taken for 3 s then, and other calls wait for the provider's thread,
/// the stream ends as Overloaded.
///
/// ```cpp
/// for (const survey::Photo& photo : surveyor.within(1min).fly(kField)) {
///   show(photo);
///   if (photo.along_m >= 100) break;  // destroys the stream, which tells the provider
/// }
/// ```
template <class T>
class [[nodiscard]] Stream {
 public:
  /// `take` moves the result out of an out struct. Used by generated code.
  Stream(std::shared_ptr<PendingStream> pending, std::shared_ptr<Channel> channel, T (*take)(void*))
      : pending_(std::move(pending)), channel_(std::move(channel)), take_(take) {}
  Stream(Stream&&) noexcept = default;
  Stream& operator=(Stream&& other) noexcept {
    if (this != &other) {
      if (pending_) pending_->drop();
      pending_ = std::move(other.pending_);
      channel_ = std::move(other.channel_);
      take_ = other.take_;
    }
    return *this;
  }
  ~Stream() {
    if (pending_) pending_->drop();
  }

  /// Waits for the next result; nullopt at the end of the stream. Throws the error that ended it
  /// otherwise: an exception that the interface declares, or an Error (TimedOut at the deadline).
  std::optional<T> next() {
    const auto item = pending().next();
    if (!item) return std::nullopt;
    return take_(item.get());
  }

  /// `co_await stream.next_async()` is next() without a thread that waits. The coroutine resumes on
  /// the connection's continuation executor. Do not move or destroy the stream meanwhile.
  auto next_async() {
    struct Awaiter {
      Stream& stream;
      bool await_ready() const { return stream.pending().ready(); }
      void await_suspend(std::coroutine_handle<> waiting) {
        Executor& executor = stream.channel_->continuations();
        stream.pending().on_ready(
            [&executor, waiting] { executor.post_or_run([waiting] { waiting.resume(); }); });
      }
      std::optional<T> await_resume() { return stream.next(); }
    };
    return Awaiter{*this};
  }

  /// Whether next() would return at once.
  bool ready() const { return pending().ready(); }

  /// Runs `action` when ready(): at once, or on the thread that delivers, possibly one of the
  /// library's. It must neither block nor run user code. One action at a time, and no next_async()
  /// beside it.
  void notify(std::function<void()> action) { pending().on_ready(std::move(action)); }

  /// Cancels the operation, unless it has ended, notifies the provider, and drops the results that
  /// were not taken. next() then throws Cancelled.
  void cancel() { pending().drop(); }

  /// For a range-for, which takes the results that are left and throws as next() does.
  class Iterator {
   public:
    using value_type = T;
    using difference_type = std::ptrdiff_t;
    explicit Iterator(Stream& stream) : stream_(&stream), item_(stream.next()) {}
    T& operator*() const { return *item_; }
    Iterator& operator++() {
      item_ = stream_->next();
      return *this;
    }
    void operator++(int) { ++*this; }
    bool operator==(std::default_sentinel_t) const { return !item_; }

   private:
    Stream* stream_;
    mutable std::optional<T> item_;
  };
  Iterator begin() { return Iterator(*this); }
  std::default_sentinel_t end() const { return {}; }

 private:
  PendingStream& pending() const {
    if (pending_) return *pending_;
    throw InvalidArgument("this stream was moved from; use the object that it was moved to");
  }

  std::shared_ptr<PendingStream> pending_;
  std::shared_ptr<Channel> channel_;
  T (*take_)(void*);
};

/// Where the implementation of a stream puts its results. The operation gets one instead of
/// returning a value; the stream ends when the operation returns or throws. Do not use it after
/// that. One thread at a time.
template <class T>
class StreamSink {
 public:
  virtual ~StreamSink() = default;

  /// Sends a result. While the caller is too far behind, it waits, and blocks the service's thread.
  /// Throws Cancelled if nobody waits for results any more, Disconnected if the service is being
  /// withdrawn, TimedOut after the deadline, Overloaded if the caller takes nothing for 3 s while
  /// other calls wait for the thread, or if a result to another process finds no room, Internal for
  /// a value that CDR cannot carry there. An implementation need not catch them.
  void push(T item) { put(std::move(item), true); }

  /// As push(), but does not wait: returns false, and does not send the result, if the caller is
  /// too far behind.
  bool try_push(T item) { return put(std::move(item), false); }

 private:
  virtual bool put(T item, bool wait) = 0;
};

}  // namespace skein
