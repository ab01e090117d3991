#pragma once

#include <condition_variable>
#include <coroutine>
#include <cstdint>
#include <deque>
#include <functional>
#include <iterator>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "skein/core/channel.hpp"

namespace skein {

/// A call that brings many results: a PendingCall with a queue of out structs that have arrived and
/// were not taken yet. The other side may send only what it was granted, so the queue never holds
/// more than kWindow. An operation that is a stream is started with this class and no other.
class PendingStream final : public PendingCall {
 public:
  /// How many results may be on their way, or wait here, at a time.
  static constexpr std::uint32_t kWindow = 8;

  /// An out struct, freed by its TypeSupport; null at the end of the stream.
  using Item = std::unique_ptr<void, void (*)(void*) noexcept>;

  PendingStream(const OperationInfo& operation, Instant deadline);

  /// For lanes: what lets the other side send so many more. It may throw, which ends the stream.
  void set_granter(std::function<void(std::uint32_t)> granter);

  /// For lanes: queues a result. False, and the result is dropped, where it was not granted; a
  /// stream that has ended takes everything and keeps nothing.
  bool deliver(Item item);

  /// For lanes: how many results have been queued so far.
  std::uint64_t delivered() const;

  /// Whether next() would return at once.
  bool ready() const;

  /// Waits for the next result. Results that have arrived come before what ended the stream, which
  /// is thrown once; then, and after a regular end, null.
  Item next();

  /// Runs `action` once next() would not block, at once where that is so; where not, on the thread
  /// that delivers: it must neither block nor run user code. One action at a time.
  void on_ready(std::function<void()> action);

  /// Cancels the call, unless it has ended, and forgets what was not taken.
  void drop();

 private:
  void end();
  void grant_taken();

  mutable std::mutex items_mutex_;
  std::condition_variable arrived_;
  std::deque<Item> items_;
  std::uint64_t delivered_ = 0;
  std::uint32_t taken_ = 0;  // and not granted anew yet
  bool ended_ = false;
  std::function<void()> waiter_;
  std::function<void(std::uint32_t)> granter_;
};

/// The results of an operation that `#pragma stream` declares, as they come. Move-only; dropping it
/// cancels the operation. One thread at a time. The deadline of the call is that of the whole
/// stream.
///
/// Whoever takes slowly slows the provider down: it may be PendingStream::kWindow results ahead,
/// then waits.
template <class T>
class Stream {
 public:
  /// `take` moves the result out of an out struct. Used by generated code.
  Stream(std::shared_ptr<PendingStream> pending, std::shared_ptr<Channel> channel, T (*take)(void*))
      : pending_(std::move(pending)), channel_(std::move(channel)), take_(take) {}
  Stream(Stream&&) noexcept = default;
  Stream& operator=(Stream&& other) noexcept {
    std::swap(pending_, other.pending_);
    std::swap(channel_, other.channel_);
    std::swap(take_, other.take_);
    return *this;
  }
  ~Stream() {
    if (pending_) pending_->drop();
  }

  /// Waits for the next result; nothing at the end of the stream. Throws what ended it otherwise:
  /// an exception that the interface declares, or an Error (TimedOut at the deadline).
  std::optional<T> next() {
    const auto item = pending_->next();
    if (!item) return std::nullopt;
    return take_(item.get());
  }

  /// `co_await stream.next_async()` is next() without a thread that waits: the coroutine goes on,
  /// on the connection's executor. The stream must stay where it is meanwhile.
  auto next_async() {
    struct Awaiter {
      Stream& stream;
      bool await_ready() const { return stream.pending_->ready(); }
      void await_suspend(std::coroutine_handle<> waiting) {
        Executor& executor = stream.channel_->continuations();
        stream.pending_->on_ready(
            [&executor, waiting] { executor.post_or_run([waiting] { waiting.resume(); }); });
      }
      std::optional<T> await_resume() { return stream.next(); }
    };
    return Awaiter{*this};
  }

  /// Whether next() would return at once.
  bool ready() const { return pending_->ready(); }

  /// Runs `action` once that is so, on the thread that delivers, which may be a vendor's: it must
  /// neither block nor run user code. One action at a time, and no next_async() beside it.
  void notify(std::function<void()> action) { pending_->on_ready(std::move(action)); }

  /// Tells the provider that nobody waits any more; a later next() throws Cancelled.
  void cancel() { pending_->drop(); }

  /// For a range-for, which takes what is left and throws as next() does.
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
  std::shared_ptr<PendingStream> pending_;
  std::shared_ptr<Channel> channel_;
  T (*take_)(void*);
};

}  // namespace skein
