#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include "view/socket_frame.hpp"

namespace skein::view {

/// What waits for one client. Samples wait in a queue of bounded size: the oldest make room for the
/// newest, and are counted. Messages without which the client would be wrong about the server wait
/// before them, and are never dropped. Not thread-safe.
class Outbox {
 public:
  /// `capacity` in bytes, of each of the two queues.
  explicit Outbox(std::size_t capacity) : capacity_(capacity) {}

  /// A message that must arrive. False: there is no room for it, and the client is to go.
  [[nodiscard]] bool push(Frame message);

  /// A sample of the client's `subscription`. One that is larger than the queue waits alone.
  void push_sample(std::uint32_t subscription, Frame sample);

  /// Drops the samples of a subscription that has ended; these do not count.
  void forget(std::uint32_t subscription);

  /// What is to be sent next.
  std::optional<Frame> pop();

  /// Samples that found no room, since the start.
  std::uint64_t dropped() const { return dropped_; }

 private:
  struct Sample {
    std::uint32_t subscription;
    Frame frame;
  };

  const std::size_t capacity_;
  std::deque<Frame> messages_;
  std::size_t message_bytes_ = 0;
  std::deque<Sample> samples_;
  std::size_t sample_bytes_ = 0;
  std::uint64_t dropped_ = 0;
};

}  // namespace skein::view
