#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "core/system/file_descriptor.hpp"
#include "futex.hpp"
#include "skein/clock.hpp"
#include "skein/detail/bytes.hpp"
#include "skein/error.hpp"

/// One direction of a connection: messages from one writer to one reader, through a ring of octets
/// that both processes map. Each side trusts what it keeps itself, and nothing that the other one
/// can write: what it reads there it copies, checks, and then uses.
///
/// A message lies in the ring as one frame or several, each with a header of eight octets: how
/// many octets of the message follow, and what the frame is. Frames begin at multiples of eight and
/// do not go beyond the ring's end.
///
/// Memory order. Content and headers of frames are published by `written`: the writer's store
/// releases them, the reader's load acquires them. The room goes back by `read` in the same way, so
/// that the writer overwrites nothing that is still being copied out. A side that falls asleep
/// writes its word (`reader_sleeps` …), then reads the other side's position; that one writes its
/// position, then reads the word. All four accesses are sequentially consistent: in their one order
/// the later of both reads sees the other side's write, and no wake-up is lost. With release and
/// acquire alone, both could miss it. The reader's own `read_` and `written_` may be relaxed:
/// threads that take in turn hand the ring to each other under a lock. So may the cores: a stale
/// one only puts off a wake-up that follows in any case (Part::lets_sleep).
namespace skein::same_host {

/// What both sides of a ring change, apart from its content: how far they are, and whether they
/// sleep. All zero at first. What one side writes in the main has a cache line of its own.
struct RingState {
  alignas(64) std::atomic<std::uint64_t> written{0};  ///< Octets, ever.
  alignas(64) std::atomic<std::uint64_t> read{0};     ///< Of those.
  alignas(64) Word reader_sleeps{0};                  ///< 1 while it may sleep.
  Word caller_sleeps{0};  ///< 1 while a thread that reads for itself may sleep on this word.
  Word caller_reads{0};   ///< 1 while such a thread is to take what comes: the reader is not woken.
  Word reader_core{0};    ///< Where it went to sleep, from 1 on; 0: it is to be woken at once.
  Word caller_core{0};
  Word reader_gone{0};  ///< 1 once it takes nothing more.
  alignas(64) Word writer_sleeps{0};
};
static_assert(std::atomic<std::uint64_t>::is_always_lock_free && sizeof(RingState) == 256);

/// Where a ring lies.
struct RingPlace {
  RingState* state = nullptr;
  std::byte* content = nullptr;
  std::size_t capacity = 0;  ///< Octets; a multiple of 8.
};

/// The other side has written what no sound peer writes; the ring is not to be used any more. Which
/// calls ran is unknown.
class BrokenRing : public Disconnected {
 public:
  explicit BrokenRing(const std::string& why)
      : Disconnected("the other side has damaged the memory that it shares: " + why) {}
};

/// Puts messages in. Not thread-safe.
class RingWriter {
 public:
  /// `doorbell` wakes the reader; it outlives the writer. None: the reader never sleeps.
  RingWriter(const RingPlace& place, const FileDescriptor& doorbell)
      : place_(place), doorbell_(doorbell) {}

  /// A message on its way.
  struct Part {
    std::span<const std::byte> rest;
    bool lends = false;  ///< See RingReader::lends().
    bool begun = false;
    bool lets_sleep =
        false;  ///< A reader that sleeps on this core is not woken: see wake_reader().
  };

  /// Puts in what there is room for, and wakes the reader if it sleeps; whether that was all. A
  /// message that is never finished is passed over by the reader once the next one begins. Throws
  /// BrokenRing.
  bool put(Part& part);

  /// Puts all of it in. It gives up if it has waited for room for as long as `patience`, however
  /// much the reader takes meanwhile, or if `ended` is so (which wake() makes it look at); false
  /// then. Throws BrokenRing.
  bool write(Part message, Duration patience, const std::function<bool()>& ended);

  /// After messages that let it sleep. From any thread.
  void wake_reader(Wakes& wakes);
  /// Whether a reader sleeps that was last seen on this thread's core.
  bool reader_sleeps_here() const;

  /// Whether the reader takes nothing more, so that a message put in now is not received.
  bool reader_gone() const { return place_.state->reader_gone.load() != 0; }

  /// Waits until the reader has taken everything; false at the deadline, or once `ended` is so.
  bool await_empty(Instant deadline, const std::function<bool()>& ended);

  /// Lets a thread that waits here look whether it is over. From any thread.
  void wake() { wake(place_.state->writer_sleeps); }

  /// How often it had to ask the kernel to wake the reader.
  std::uint64_t wakes() const noexcept { return wakes_; }

  /// False where there is room already, or the ring is empty: else the reader wakes who sleeps
  /// while `state.writer_sleeps` is 1. With stay_awake() after it, what waiting is made of.
  bool prepare_to_sleep();
  void stay_awake() { place_.state->writer_sleeps.store(0); }

 private:
  static bool is_to_be_woken(Word& sleeps);
  bool reader_sleeps() const;
  bool ring_reader();
  static bool wake(Word& sleeps);
  std::uint64_t in_flight();
  bool may_restart(std::size_t offset, std::size_t size);
  void put_frame(std::uint32_t kind, std::span<const std::byte> content);
  enum class More { Follows, No };
  void publish(More more);
  bool await_change(Instant deadline, const std::function<bool()>& ended);

  const RingPlace place_;
  const FileDescriptor& doorbell_;
  std::uint64_t written_ = 0;  // some of it not published yet
  std::uint64_t read_ = 0;     // as last seen
  std::size_t look_at_ = 0;    // the offset from which on it is looked whether the ring is empty
  std::uint64_t wakes_ = 0;
};

/// Takes messages out. take() is for one thread at a time; the rest is thread-safe.
class RingReader {
 public:
  /// Two threads may wait: the one whose work it is, and one in its place.
  enum class Who { Reader, Caller };

  /// A message that takes more than `largest` octets breaks the ring.
  RingReader(const RingPlace& place, std::size_t largest) : place_(place), largest_(largest) {}

  /// Appends to `message`, which is this ring's alone, and is cleared when the next message begins,
  /// what has come; whether the message is whole. Throws BrokenRing.
  bool take(Bytes& message);

  /// Whether the message that take() has completed ends with what says of a loan: see loans.hpp.
  bool lends() const noexcept { return lends_; }

  /// Whether something has come.
  bool ready() const {
    // What was seen before is looked at first: the line that the other side writes costs more.
    const std::uint64_t read = read_.load(std::memory_order_relaxed);
    return written_.load(std::memory_order_relaxed) > read ||
           place_.state->written.load(std::memory_order_acquire) != read;
  }

  /// False if something has come that this one is to take. Else the writer sets `word()` to 0 when
  /// something comes; it rings the reader's doorbell, or wakes a caller that sleeps on the word.
  bool prepare_to_sleep(Who who = Who::Reader);
  void stay_awake(Who who = Who::Reader) { word(who).store(0); }
  Word& word(Who who = Who::Reader) const noexcept {
    return who == Who::Reader ? place_.state->reader_sleeps : place_.state->caller_sleeps;
  }

  /// From lend() to take_back() what comes is a caller's: the reader is not woken for it.
  void lend() {
    if (!lent()) place_.state->caller_reads.store(1);
  }
  /// Whether something has come meanwhile, for which the reader was not woken.
  bool take_back() {
    if (!lent()) return false;
    place_.state->caller_reads.store(0);
    return place_.state->written.load() != read_;
  }
  bool lent() const { return place_.state->caller_reads.load() != 0; }

 private:
  std::uint64_t available();
  void release(std::uint64_t size);

  const RingPlace place_;
  const std::size_t largest_;
  // Changed by take().
  std::atomic<std::uint64_t> read_{0};
  std::atomic<std::uint64_t> written_{0};  // as last seen
  bool begun_ = false;
  bool lends_ = false;
};

}  // namespace skein::same_host
