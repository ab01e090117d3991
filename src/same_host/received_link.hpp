#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <utility>

#include "call_port/call_port.hpp"
#include "dds/port/largest_sample.hpp"
#include "doorbell.hpp"
#include "lead.hpp"
#include "link.hpp"
#include "skein/clock.hpp"
#include "sleepers.hpp"
#include "spin_policy.hpp"

namespace skein::same_host {

/// Gets messages of links. Called on the receiver's thread or a caller's: one call at a time for
/// each link, apart from calls that have left their turn. A call returns soon or leaves its turn.
class Inbox {
 public:
  virtual ~Inbox() = default;
  virtual void on_begin(Link& link) = 0;
  virtual void on_message(Link& link, std::span<const std::byte> message, calls::Turn& turn) = 0;
  /// Nothing more comes through this one.
  virtual void on_end(Link& link) = 0;
};

/// Octets of messages that have not come to their end. Thread-safe.
class Unfinished {
 public:
  /// How many there may be in all, so that a lone link may bring the largest message.
  static constexpr std::size_t kMost = 2 * std::size_t{dds::kLargestSample};

  explicit Unfinished(std::size_t most = kMost) : most_(most) {}

  /// A link that had `before` has `now`; how many others have.
  std::size_t change(std::size_t before, std::size_t now) noexcept {
    return all_.fetch_add(now - before) - before;
  }
  std::size_t most() const noexcept { return most_; }

 private:
  const std::size_t most_;
  std::atomic<std::size_t> all_{0};
};

/// Wakes the thread that leads a receiver. Outlives the receiver, as links may.
///
/// Memory order. A flag is written before the leader is called, and the leader forgets the call
/// before it looks at the flags (all sequentially consistent): if it misses a flag, it is called
/// again.
struct ReceiverNews {
  void tell_of_changes() {
    changed = true;
    doorbells.call();
  }

  void tell_of_pause() {
    if (!paused && !paused.exchange(true)) doorbells.call();
  }

  Doorbells doorbells;
  std::atomic<bool> changed{false};  // a link is new, has ended, or was taken back
  std::atomic<bool> paused{false};   // a caller has, and has not been looked for since
};

/// A thread that takes messages: one that leads, which is the receiver's or a consumer in its
/// place, or a caller.
struct Taker {
  enum class Who { Receiver, Consumer, Caller };
  explicit Taker(Who who_) : who(who_) {}
  Taker(Who who_, Lead* lead_, std::function<void()> wake_peers_)
      : who(who_), lead(lead_), wake_peers(std::move(wake_peers_)) {}

  /// Those that sleep.
  void wake() {
    if (!sleepers.any()) return;
    sleepers.clear();
    wake_peers();
  }

  const Who who;
  Lead* const lead = nullptr;  ///< None of a caller, which lets nobody sleep, either.
  const std::function<void()> wake_peers;
  std::uint64_t left = 0;  ///< Not 0: the turn is left; the token of Lead::leave().
  Sleepers sleepers{[this] { return left != 0 && !lead->is_left(left); }};
  bool others_wait = false;  ///< Whether links that come after this one have something.
};

/// One link of a receiver: takes its messages on the thread that leads, or on a caller's that waits
/// for one. Once it is over, the inbox and the receiver may be gone. Thread-safe but for
/// `attended` and `pauses_seen`, which belong to the thread that leads; one caller uses it at a
/// time.
class ReceivedLink final : public calls::CallerDelivery {
 public:
  enum class Looked { Nothing, Something, Replaced };

  /// `id` is its doorbell's.
  ReceivedLink(std::shared_ptr<Link> link_, Inbox& inbox_, std::uint64_t id_, Duration spin,
               std::shared_ptr<Unfinished> unfinished, std::shared_ptr<ReceiverNews> news)
      : link(std::move(link_)),
        inbox(inbox_),
        id(id_),
        unfinished_(std::move(unfinished)),
        news_(std::move(news)),
        spin_(spin) {}

  void lend() override;
  void pause() override;
  void take_back() override;
  // noexcept: an exception would unwind the frame to which the call's result is written later.
  void deliver_until(const std::function<bool()>& done) noexcept override;
  void wake() override;

  /// Whether it has something for the leading thread.
  bool has_something() const {
    if (over_) return false;
    return !begun_ || link->ended() || (link->in().ring().ready() && !link->in().ring().lent());
  }
  /// Takes some messages. Replaced: one of them left the turn, and another thread leads by now.
  Looked look(Bytes& spare, Taker& taker);
  /// The inbox gets nothing more, apart from a call that has left its turn and still runs.
  void remove();
  /// Nobody need wait for it any more.
  bool over() const { return over_; }
  /// Odd while a caller pauses.
  std::uint32_t pauses() const { return pauses_; }

  const std::shared_ptr<Link> link;
  Inbox& inbox;
  const std::uint64_t id;
  // Of the leading thread.
  bool attended = false;
  std::uint32_t pauses_seen = 0;

 private:
  bool brings_too_much();
  void sleep(const std::function<bool()>& done);

  const std::shared_ptr<Unfinished> unfinished_;
  const std::shared_ptr<ReceiverNews> news_;
  std::mutex mutex_;  // held while a function of the inbox runs
  std::atomic<bool> begun_{false};
  std::size_t octets_ = 0;  // unfinished ones, as others know it; under the mutex
  int turns_after_end_ = 0;
  std::atomic<std::uint32_t> pauses_{0};
  std::atomic<bool> over_{false};
  std::atomic<bool> has_caller_{false};  // which is in deliver_until()
  // The caller's.
  SpinPolicy spin_;
  std::atomic<bool> called_{false};
  std::atomic<bool> sleeps_{false};
};

}  // namespace skein::same_host
