#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>

#include "link_state.hpp"
#include "loans.hpp"
#include "ring.hpp"
#include "skein/clock.hpp"
#include "sleepers.hpp"

namespace skein::same_host {

/// The half of a link that sends. Thread-safe.
class LinkWriter {
 public:
  enum class Sent { Yes, NoRoom, Ended };

  /// `state` is that of the link to which this half belongs.
  explicit LinkWriter(LinkState& state)
      : state_(state), ring_(state.outgoing(), state.doorbells().out) {}

  /// How long all of a message may wait for room. `left`, if any, says how much time its sender
  /// has; like `on_full` it is called only before the message waits.
  struct Patience {
    template <class Rep, class Period>
    Patience(std::chrono::duration<Rep, Period> longest_) : longest(longest_) {}
    Patience(Duration longest_, const std::function<void()>& on_full_,
             const std::function<Duration()>* left_)
        : longest(longest_), on_full(&on_full_), left(left_) {}

    Duration begin() const;

    Duration longest;
    const std::function<void()>* on_full = nullptr;
    const std::function<Duration()>* left = nullptr;
  };

  /// Sends a message; NoRoom if the other side does not take enough in that time. A ring that is
  /// found broken ends the link; throws BrokenRing then.
  Sent send(std::span<const std::byte> message, const Patience& patience);
  /// Like send(), but `message` leaves out `value` at `position`: it stays in the client's memory.
  /// Returns nullopt on the provider's side, or if the provider cannot be given that memory now.
  std::optional<Sent> send_lending(std::span<const std::byte> message,
                                   const std::shared_ptr<LoanMemory>& value, std::size_t position,
                                   const Patience& patience);
  /// Waits until the other side has taken everything that it will take. Returns false at the
  /// deadline, when the link ends, and if the ring is found broken.
  bool await_taken(Instant deadline);
  /// The link has ended: a thread that waits here goes on.
  void note_end() { ring_.wake(); }

  /// While it exists, this thread's messages answer requests of `requests`, the link's other ring.
  /// If the other side sleeps on this core, it may join `sleepers`: if there are some already, or
  /// if more requests wait, of this link or of others (`others`). Then wake_peer() follows.
  class Answering {
   public:
    Answering(const LinkWriter& writer, const RingReader& requests, Sleepers& sleepers,
              bool others);
    ~Answering();
    Answering(const Answering&) = delete;
    Answering& operator=(const Answering&) = delete;

   private:
    friend class LinkWriter;
    bool more_wait() const;

    const LinkWriter& writer_;
    const RingReader& requests_;
    Sleepers& sleepers_;
    const bool others_;
    const Answering* const outer_;
  };
  /// If the other side was let sleep, wakes it by the end of `wakes`. From any thread.
  void wake_peer(Wakes& wakes);

 private:
  bool ended() const { return state_.ended() || ring_.reader_gone(); }
  bool let_sleep();
  Sent write(RingWriter::Part message, const Patience& patience);
  Lender::Connection lending();
  void forget(const LoanNote& gone);

  LinkState& state_;
  std::mutex mutex_;
  RingWriter ring_;
  std::atomic<bool> lets_sleep_{false};
  std::optional<Lender> lender_;
};

}  // namespace skein::same_host
