#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "call_port/call_port.hpp"
#include "dds/port/largest_sample.hpp"
#include "doorbell.hpp"
#include "futex.hpp"
#include "lead.hpp"
#include "link.hpp"
#include "skein/clock.hpp"

namespace skein::same_host {

/// Who gets what comes through links. Called on the receiver's thread, or a caller's, one at a time
/// for each link but for who has left his turn; must return soon, or leave it.
class Inbox {
 public:
  virtual ~Inbox() = default;
  virtual void on_begin(Link& link) = 0;
  virtual void on_message(Link& link, std::span<const std::byte> message, calls::Turn& turn) = 0;
  /// Nothing more comes through this one.
  virtual void on_end(Link& link) = 0;
};

/// Whether it pays to look for the next message for a while before sleeping: it does while most
/// came soon. Costs nothing once they come late.
class SpinPolicy {
 public:
  /// `limit`: how long to look at most; 0: never.
  explicit SpinPolicy(Duration limit) : limit_(limit) {}

  Duration limit() const { return limit_; }
  /// How long to look now.
  Duration budget() const { return score_ >= kEnough ? limit_ : Duration::zero(); }
  /// Something came this long after the wait for it had begun.
  void note(Duration waited);

 private:
  static constexpr int kMost = 16;
  static constexpr int kEnough = 8;

  Duration limit_;
  int score_ = 0;
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

/// One thread that takes messages from many links, and sleeps while none has any; links that bring
/// nothing cost it nothing. A thread that waits for a message of one link may take it itself; one
/// that waits for any link's may lead in the receiver's place. If that one leaves its turn, and
/// does not come back within 10 ms, the receiver's own thread takes what comes until it does. A
/// link that brings more of a message without its end than others leave room for is ended.
/// Thread-safe.
class Receiver {
 public:
  /// `name` is the thread's, which starts with the first link; `spin` as SpinPolicy's limit.
  Receiver(std::string name, TimeSpan spin,
           std::shared_ptr<Unfinished> unfinished = std::make_shared<Unfinished>());
  /// No function of an inbox runs any more, but for those that have left the turn of a thread that
  /// led in the receiver's place.
  ~Receiver();
  Receiver(const Receiver&) = delete;
  Receiver& operator=(const Receiver&) = delete;

  /// For Link: makes the thread look whether links have ended. It may outlive the receiver.
  std::function<void()> notifier() const;

  /// Throws Unavailable where there is no thread. What it returns is for threads that wait for what
  /// this link brings.
  std::shared_ptr<calls::CallerDelivery> add(std::shared_ptr<Link> link, Inbox& inbox);
  /// For one thread that takes what all links bring. Between its calls of deliver_until() it is as
  /// one that has left its turn: take_back() says that it does not come back soon. For inboxes that
  /// leave their turn on no other thread.
  std::shared_ptr<calls::CallerDelivery> delivery() const;
  /// None of its functions runs, or will run, but for those whose turn was left: these may outlive
  /// the inbox, and must not use it any more. Not from one of them.
  void remove(Inbox& inbox);
  std::size_t links() const;

 private:
  class Entry;
  class Consumer;
  class OwnTurn;
  using Entries = std::vector<std::shared_ptr<Entry>>;
  enum class Who { Receiver, Consumer, Caller };
  enum class Looked { Nothing, Something, Replaced };
  struct News;
  struct Taker;

  void run();
  bool lead(Who who, const std::function<bool()>& over);
  Looked look_at(Entry& entry, Bytes& spare, Taker& taker);
  bool brings_too_much(Entry& entry);
  Looked look_at_all(Taker& taker);
  void take_in_changes();
  void attend(const std::shared_ptr<Entry>& entry);
  bool attend_rung(std::optional<std::chrono::milliseconds> longest);
  void wake(Sleepers& sleepers) const;
  void wake_peers() const;
  void await();
  bool may_sleep();
  void sleep();
  void take_back_paused();

  const std::string name_;
  const Duration spin_limit_;
  const std::shared_ptr<Unfinished> unfinished_;
  const std::shared_ptr<News> news_;
  mutable std::mutex mutex_;
  Entries entries_;
  Entries added_;  // since the leading thread last looked
  std::uint64_t last_id_ = 0;
  std::thread thread_;
  std::atomic<bool> stopping_{false};
  const std::shared_ptr<Lead> lead_ = std::make_shared<Lead>();
  const std::shared_ptr<Consumer> consumer_;
  // The leading thread's. A consumer that has left its turn keeps no link from ending.
  std::map<std::uint64_t, std::shared_ptr<Entry>> led_;
  Entries attended_;  // of those: the others' doorbells ring
  int turns_ = 0;     // since the doorbells were last listened to
  Instant look_at_paused_ = Instant::max();
  SpinPolicy spin_;
  Bytes spare_;
};

}  // namespace skein::same_host
