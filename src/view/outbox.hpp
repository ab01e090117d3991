#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>

#include "view/socket_frame.hpp"

namespace skein::view {

/// What waits for one client. Samples wait in a queue of bounded size: the oldest make room for the
/// newest, and one that has waited longer than kLongestWait goes if its subscription has a newer
/// one, so that a slow client sees what is, not what was. Both are counted. Messages without which
/// the client would be wrong about the server wait before them, and are never dropped. Not
/// thread-safe.
class Outbox {
 public:
  using Clock = std::chrono::steady_clock;
  using Time = Clock::time_point;

  /// `capacity` in bytes, of each of the two queues.
  explicit Outbox(std::size_t capacity) : capacity_(capacity) {}

  /// A message that must arrive. False: there is no room for it, and the client is to go.
  [[nodiscard]] bool push(Frame message);

  static constexpr std::chrono::seconds kLongestWait{1};

  /// A sample of the client's `subscription`. One that is larger than the queue waits alone.
  void push_sample(std::uint32_t subscription, Frame sample, Time now = Clock::now());

  /// Drops the samples of a subscription that has ended; these do not count.
  void forget(std::uint32_t subscription);

  /// What is to be sent next.
  std::optional<Frame> pop(Time now = Clock::now());

  /// Samples that found no room or became too old, since the start.
  std::uint64_t dropped() const { return dropped_; }

 private:
  struct Sample {
    std::uint32_t subscription;
    Frame frame;
    Time since;
  };

  /// The oldest one, which must be there.
  Frame take_sample();
  void drop_old(Time now);

  const std::size_t capacity_;
  std::deque<Frame> messages_;
  std::size_t message_bytes_ = 0;
  std::deque<Sample> samples_;
  std::size_t sample_bytes_ = 0;
  std::map<std::uint32_t, std::size_t> waiting_;  // samples by subscription
  std::uint64_t dropped_ = 0;
};

}  // namespace skein::view
