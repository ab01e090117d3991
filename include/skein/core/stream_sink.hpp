#pragma once

#include <utility>

namespace skein {

/// Where the implementation of a stream puts its results: the operation gets one instead of
/// returning a value, and the stream ends when the operation returns or throws. Not to be used
/// after that; one thread at a time.
template <class T>
class StreamSink {
 public:
  virtual ~StreamSink() = default;

  /// Hands a result over. Waits while the caller is too far behind to be sent more, and with it the
  /// thread of the service. Throws Cancelled where nobody waits for results any more, TimedOut
  /// where the deadline has passed; an implementation need not catch them.
  void push(T item) { put(std::move(item), true); }

  /// As push(), but does not wait: false, and the result is not sent, where the caller is too far
  /// behind.
  bool try_push(T item) { return put(std::move(item), false); }

 private:
  virtual bool put(T item, bool wait) = 0;
};

/// How a skeleton hands the results of a stream to the lane: what a stream's Servant::dispatch()
/// gets as its `out`.
class StreamWriter {
 public:
  virtual ~StreamWriter() = default;

  /// Sends one out struct. False where there is no room and `wait` is false; throws as
  /// StreamSink::push().
  virtual bool put(const void* out, bool wait) = 0;
};

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
