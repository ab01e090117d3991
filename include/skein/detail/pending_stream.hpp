#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <utility>

#include "skein/detail/channel.hpp"

namespace skein {

/// A call with many results: a PendingCall with a queue of out structs that have arrived and were
/// not taken yet. The other side may send only as many as it was granted, so the queue never holds
/// more than kWindow. A stream operation must be started with this class.
class PendingStream final : public PendingCall {
 public:
  /// Maximum number of results that are under way or wait here.
  static constexpr std::uint32_t kWindow = 8;

  /// An out struct, freed by its TypeSupport; null at the end of the stream.
  using Item = std::unique_ptr<void, void (*)(void*) noexcept>;

  PendingStream(const OperationInfo& operation, Instant deadline);

  /// For transports: the function that grants the other side further results. If it throws, the
  /// stream ends.
  void set_granter(std::function<void(std::uint32_t)> granter);

  /// For transports: queues a result. Returns false, and drops the result, if it was not granted.
  /// After the end it returns true and drops the result.
  bool deliver(Item item);

  /// For transports: number of results queued so far.
  std::uint64_t delivered() const;

  /// Whether next() would return at once.
  bool ready() const;

  /// Waits for the next result. Results that have arrived come first, then the error that ended the
  /// stream (thrown once), then null.
  Item next();

  /// Runs `action` when next() would not block: at once, or on the thread that delivers. It must
  /// neither block nor run user code. One action at a time.
  void on_ready(std::function<void()> action);

  /// Cancels the call, unless it has ended, and drops the results that were not taken.
  void drop();

 private:
  void end();
  bool is_slow();
  void grant_taken(bool at_once);

  mutable std::mutex items_mutex_;
  std::condition_variable arrived_;
  std::deque<Item> items_;
  std::uint64_t delivered_ = 0;
  std::uint32_t taken_ = 0;  // and not granted again yet
  Instant taken_at_{};       // when the provider was seen to wait
  bool ended_ = false;
  std::function<void()> waiter_;
  std::function<void(std::uint32_t)> granter_;
};

/// How a skeleton passes the results of a stream to the transport: the `out` of Servant::dispatch()
/// for a stream.
class StreamWriter {
 public:
  virtual ~StreamWriter() = default;

  /// Sends one out struct. Returns false if there is no room and `wait` is false. Throws as
  /// StreamSink::push() does.
  virtual bool put(const void* out, bool wait) = 0;
};

template <class T>
class StreamSink;

/// The sink over a StreamWriter. Used by generated code.
template <class T, class Out>
class WritingSink final : public StreamSink<T> {
 public:
  explicit WritingSink(void* writer) : writer_(*static_cast<StreamWriter*>(writer)) {}

 private:
  bool put(T item, bool wait) override {
    const Out out{std::move(item)};
    return writer_.put(&out, wait);
  }

  StreamWriter& writer_;
};

}  // namespace skein
