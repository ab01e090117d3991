#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <unordered_map>
#include <utility>

#include "skein/clock.hpp"
#include "skein/detail/call_memory.hpp"
#include "skein/detail/channel.hpp"

namespace skein::rpc {

/// The calls of a connection that wait for their answers, by number, and one timer for all of their
/// deadlines: steady calls come and go without it. Thread-safe.
class PendingCalls : public std::enable_shared_from_this<PendingCalls> {
 public:
  using Call = std::shared_ptr<PendingCall>;
  using All = std::pmr::unordered_map<std::uint64_t, Call>;
  enum class Keep { Nothing, Streams };

  /// `on_due` is called on the clock's thread with the number of each call whose deadline is over.
  PendingCalls(Clock& clock, std::size_t most, std::function<void(std::uint64_t)> on_due)
      : clock_(clock), most_(most), on_due_(std::move(on_due)) {}

  /// Returns the call's number, 1 or more; 0 if there is no room; nullopt after close().
  std::optional<std::uint64_t> add(const Call& call);
  struct Removed {
    Call call;
    bool last = false;  ///< No other call waits.
  };
  /// Forgets the call's number and returns the call; null if the number is unknown. With
  /// Keep::Streams a stream's number stays known.
  Removed remove(std::uint64_t number, Keep keep = Keep::Nothing);
  /// Takes no call from now on. Returns those that waited.
  All close();
  /// As close(), but only if no call waits; otherwise returns false.
  bool close_if_empty();

  std::size_t size() const;
  /// How many were added, ever.
  std::uint64_t total() const;

 private:
  TimerId look_at(Instant deadline);
  void tell_due();

  Clock& clock_;
  const std::size_t most_;
  const std::function<void(std::uint64_t)> on_due_;
  mutable std::mutex mutex_;
  All all_{&call_memory()};
  std::uint64_t last_ = 0;
  bool closed_ = false;
  TimerId timer_ = 0;
  Instant timer_due_ = Instant::max();
};

}  // namespace skein::rpc
