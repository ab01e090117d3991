#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <utility>
#include <vector>

#include "rpc/service/introspection_topic.hpp"
#include "rpc/wire/common.hpp"
#include "skein/clock.hpp"

namespace skein::introspection {

/// Writes an entity's values on one of these topics, while somebody reads it. Off, it costs the
/// look at a flag. On, values are gathered, so that a sample holds many: what is told for each call
/// must not cost a wake-up and a packet each. Those for which there is no room are dropped and
/// counted. `Batch` has the members `values` and `dropped`; `size_of` is found for its values.
/// Thread-safe.
template <class Batch>
class BatchPublisher : public AnyPublisher {
 public:
  using Values = decltype(Batch::values);
  using Value = typename Values::value_type;

  /// What may wait, in bytes of memory, and what a sample holds: where one value is larger, that
  /// alone.
  static constexpr std::size_t kMostWaiting = std::size_t{64} << 20;
  static constexpr std::size_t kMostInSample = std::size_t{48} << 10;

  /// All live until close().
  BatchPublisher(dds::Participant& participant, Clock& clock, Executor& control,
                 const Topic<Batch>& topic)
      : AnyPublisher(participant, control, topic), clock_(clock), interval_(topic.interval) {}
  /// As close().
  ~BatchPublisher() { close(); }

  /// Does nothing while nobody reads.
  void publish(Value value) {
    if (!on()) return;
    const std::size_t size = size_of(value);
    std::lock_guard lock(mutex_);
    if (closed_) return;
    if (waiting_size_ > 0 && waiting_size_ + size > kMostWaiting) {
      ++dropped_;
      return;
    }
    waiting_size_ += size;
    waiting_.push_back(std::move(value));
    if (std::exchange(gathering_, true)) return;
    timer_ = clock_.call_after(interval_, [this] { post([this] { write_waiting(); }); });
  }

  /// Writes what waits, and what AnyPublisher::close() says.
  void close() {
    TimerId timer;
    {
      std::lock_guard lock(mutex_);
      closed_ = true;
      timer = timer_;
    }
    clock_.cancel(timer);
    write_waiting();
    AnyPublisher::close();
  }

 private:
  void write_waiting() {
    Values waiting;
    std::uint64_t dropped;
    {
      std::lock_guard lock(mutex_);
      waiting.swap(waiting_);
      waiting_size_ = 0;
      gathering_ = false;
      dropped = dropped_;
    }
    Batch batch;
    batch.dropped = dropped;
    std::size_t size = 0;
    for (Value& value : waiting) {
      const std::size_t more = size_of(value);
      if (size > 0 && size + more > kMostInSample) {
        write_batch(batch);
        size = 0;
      }
      size += more;
      batch.values.push_back(std::move(value));
    }
    if (size > 0) write_batch(batch);
  }

  void write_batch(Batch& batch) {
    thread_local Bytes message;  // keeps its room, which is found by trial
    write([&]() -> const Bytes& {
      message.clear();
      message.append(encapsulation(idl::kRepresentation<Batch>));
      idl::append_cdr(message, [&](idl::CdrWriter& writer) { encode(writer, batch); });
      return message;
    });
    if (message.capacity() > rpc::kKeptCapacity) message = Bytes();
    batch.values.clear();
  }

  Clock& clock_;
  const std::chrono::milliseconds interval_;  // a value waits for others
  std::mutex mutex_;
  Values waiting_;
  std::size_t waiting_size_ = 0;
  bool gathering_ = false;  // a timer is set
  bool closed_ = false;
  TimerId timer_ = 0;
  std::uint64_t dropped_ = 0;
};

}  // namespace skein::introspection
