#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>

#include "core/system/file_descriptor.hpp"
#include "loans.hpp"
#include "ring.hpp"
#include "shared_memory.hpp"
#include "skein/guid.hpp"
#include "sleepers.hpp"

namespace skein::same_host {

/// Runs an action once, when something ends. Thread-safe.
class Ending {
 public:
  /// False where it is over already: the action will not run.
  bool set(std::function<void()> action);
  /// The action is not running, and will not run. Not from the action.
  void forget();
  void run();

 private:
  std::mutex mutex_;  // held while the action runs
  bool over_ = false;
  std::function<void()> action_;
};

/// One connection as one side sees it: a ring each way, and the socket that the kernel hangs up
/// when the other process ends, whatever ends it. Thread-safe, but for receive().
class Link : public std::enable_shared_from_this<Link> {
 public:
  enum class Side { Provider, Client };
  enum class Sent { Yes, NoRoom, Ended };

  /// Octets of each ring.
  static constexpr std::size_t kCapacity = 256 << 10;
  /// Of the memory of both, which the provider makes.
  static constexpr std::size_t kMemory = 4096 + 2 * kCapacity;

  struct DoorbellPair {
    FileDescriptor out;  ///< This side's; it wakes the other side's reader.
    FileDescriptor in;   ///< The other side's; it wakes this side's.
  };

  /// `own` and `peer` are the endpoints' identities on this side and the other. `notify` is called
  /// when the link has ended, from any thread: there may be something for receive(), and then
  /// nothing any more.
  Link(Side side, std::shared_ptr<const FileDescriptor> socket, SharedMemory memory,
       DoorbellPair doorbells, const Guid& own, const Guid& peer, std::function<void()> notify);
  ~Link() { close(); }
  Link(const Link&) = delete;
  Link& operator=(const Link&) = delete;

  const Guid& own() const noexcept { return own_; }
  const Guid& peer() const noexcept { return peer_; }

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
  /// The same of one that has left out `value` at `position`, of a client's; nothing where the
  /// other side cannot read it where it lies.
  std::optional<Sent> send_lending(std::span<const std::byte> message,
                                   const std::shared_ptr<LoanMemory>& value, std::size_t position,
                                   const Patience& patience);
  /// Waits until the other side has taken everything; false at the deadline and at the end, also
  /// where the ring is found broken.
  bool await_taken(Instant deadline);

  /// While it exists, what this thread sends are answers to what comes in. The other side, if it
  /// sleeps on this core, becomes one of `sleepers` where there are some, or more requests wait: of
  /// this link, or `others`'. Then wake_peer() follows.
  class Answering {
   public:
    Answering(const Link& link, Sleepers& sleepers, bool others);
    ~Answering();
    Answering(const Answering&) = delete;
    Answering& operator=(const Answering&) = delete;

   private:
    friend class Link;
    bool more_wait() const;

    const Link& link_;
    Sleepers& sleepers_;
    const bool others_;
    const Answering* const outer_;
  };
  /// Wakes the other side, where it was let sleep, by the end of `wakes`. From any thread.
  void wake_peer(Wakes& wakes);

  /// One thread at a time: the next whole message, which is valid until release(), after which the
  /// next one may be asked for; or nothing. `spare` is memory that links of one thread lend each
  /// other: only a message that has not come to its end keeps some. Throws BrokenRing.
  std::optional<std::span<const std::byte>> receive(Bytes& spare);
  void release(Bytes& spare);
  /// What the message has left out, as valid as it; or null.
  const calls::LentValue* lent() const noexcept { return lent_ ? &*lent_ : nullptr; }
  /// Octets that have come of a message without its end.
  std::size_t unfinished() const noexcept { return unfinished_; }
  RingReader& in() noexcept { return in_; }
  const DoorbellPair& doorbells() const noexcept { return doorbells_; }

  /// Both sides learn of the end. Twice is no error.
  void close();
  /// Nothing more is sent. What the other side has sent before can still be received.
  void note_end();
  bool ended() const noexcept { return ended_; }
  /// Whether it ended because the other side was found to damage it.
  bool broken() const noexcept { return broken_; }

  /// For who writes: runs once the reader's thread has taken what had come before the end.
  Ending& ending() noexcept { return ending_; }

 private:
  void break_off();
  bool let_sleep();
  Sent write(RingWriter::Part message, const Patience& patience);
  Lender::Connection lending();
  void forget(const LoanNote& gone);
  std::optional<calls::LentValue> borrow();

  const Side side_;
  const std::shared_ptr<const FileDescriptor> socket_;
  const std::shared_ptr<const SharedMemory> memory_;
  const DoorbellPair doorbells_;
  const Guid own_;
  const Guid peer_;
  RingReader in_;
  Bytes message_;
  std::optional<Borrower> borrower_;
  std::optional<calls::LentValue> lent_;
  std::atomic<std::size_t> unfinished_{0};
  std::atomic<bool> ended_{false};
  std::atomic<bool> broken_{false};
  const std::function<void()> notify_;
  Ending ending_;
  std::mutex out_mutex_;
  RingWriter out_;
  std::atomic<bool> lets_sleep_{false};
  std::optional<Lender> lender_;
};

}  // namespace skein::same_host
