#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "skein/clock.hpp"
#include "skein/detail/operation.hpp"
#include "skein/error.hpp"
#include "skein/stream.hpp"

namespace skein::rpc {

/// The provider's end of a stream: lets through as many results as the caller has granted. put()
/// and finish() belong to the thread that executes the operation; grant() and stop() to any.
///
/// The caller does not decide how long it holds that thread: if other calls wait for it, and the
/// caller has granted nothing for kPatience, put() ends the stream as Overloaded.
class OutgoingStream final : public StreamWriter {
 public:
  /// Less than the time limit that calls have by default, so that those that wait are in time.
  static constexpr std::chrono::seconds kPatience{3};

  /// Sends one result, the `position`th from 0, to the caller; throws where that fails.
  using Send = std::function<void(const void* out, std::uint64_t position)>;

  /// A caller that grants nothing at the start knows no streams: it gets the last result alone.
  /// `clock` outlives the stream.
  OutgoingStream(const OperationInfo& operation, Clock& clock, Instant deadline,
                 std::uint32_t credit, Send send);

  bool put(const void* out, bool wait) override;

  /// Says whether other calls wait for the thread. Before the first put().
  void set_others_wait(std::function<bool()> others_wait);

  /// Lets so many more through.
  void grant(std::uint32_t credit);

  /// What waits in put(), and every later put(), throws an Error of this class.
  void stop(ErrorCode code, const std::string& why);

  /// After the operation has returned: the last result for a caller that knows no streams (throws
  /// Internal where there was none), and null for one that does.
  const void* finish() const;

  /// How many results have been sent.
  std::uint64_t sent() const noexcept { return sent_; }

 private:
  void await_credit(std::unique_lock<std::mutex>& lock);
  void refuse_if_over() const;

  const OperationInfo& operation_;
  Clock& clock_;
  const Instant deadline_;
  const Send send_;
  std::function<bool()> others_wait_;
  const bool last_only_;
  std::unique_ptr<void, void (*)(void*) noexcept> last_;
  std::uint64_t sent_ = 0;

  std::mutex mutex_;
  std::condition_variable changed_;
  std::uint32_t credit_;
  bool stopped_ = false;
  ErrorCode code_ = ErrorCode::Cancelled;
  std::string why_;
};

}  // namespace skein::rpc
