#pragma once

#include <linux/futex.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <climits>
#include <cstdint>
#include <ctime>
#include <optional>
#include <utility>

#include "skein/clock.hpp"

/// Sleeping on words in memory that processes share.
namespace skein::same_host {

using Word = std::atomic<std::uint32_t>;
static_assert(Word::is_always_lock_free && sizeof(Word) == sizeof(std::uint32_t));

/// Instant is CLOCK_MONOTONIC's; nothing for one that never comes.
inline std::optional<timespec> to_timespec(Instant when) {
  if (when == Instant::max()) return std::nullopt;
  const auto since = std::max(when.time_since_epoch(), Duration::zero());
  const auto whole = std::chrono::floor<std::chrono::seconds>(since);
  return timespec{whole.count(), std::chrono::nanoseconds(since - whole).count()};
}

/// Sleeps while the word has this value, until somebody wakes it or the deadline has come. It may
/// return early.
inline void futex_wait(const Word& word, std::uint32_t value, Instant deadline) {
  const auto until = to_timespec(deadline);
  syscall(SYS_futex, &word, FUTEX_WAIT_BITSET, value, until ? &*until : nullptr, nullptr,
          FUTEX_BITSET_MATCH_ANY);
}

/// The same for at most so long, without a look at the clock.
inline void futex_wait_for(const Word& word, std::uint32_t value, std::chrono::milliseconds time) {
  const timespec longest{time.count() / 1000, time.count() % 1000 * 1'000'000};
  syscall(SYS_futex, &word, FUTEX_WAIT, value, &longest, nullptr, 0);
}

inline void futex_wake(const Word& word) {
  syscall(SYS_futex, &word, FUTEX_WAKE, INT_MAX, nullptr, nullptr, 0);
}

/// Wakes who sleeps on words, those on two of them with one system call, by its end at the latest.
/// The words are to be there until then.
class Wakes {
 public:
  Wakes() = default;
  Wakes(const Wakes&) = delete;
  Wakes& operator=(const Wakes&) = delete;
  ~Wakes() {
    if (first_ != nullptr) futex_wake(*first_);
  }

  void add(Word& word) {
    Word* const first = std::exchange(first_, nullptr);
    if (first == nullptr) {
      first_ = &word;
      return;
    }
    // Leaves the second word as it is, which is not negative. Who makes his own so sleeps on; who
    // makes the kernel refuse it keeps nobody else asleep.
    constexpr std::uint32_t kAnyway = FUTEX_OP(FUTEX_OP_ADD, 0U, FUTEX_OP_CMP_GE, 0U);
    if (syscall(SYS_futex, first, FUTEX_WAKE_OP, INT_MAX, INT_MAX, &word, kAnyway) >= 0) return;
    futex_wake(*first);
    futex_wake(word);
  }

 private:
  Word* first_ = nullptr;
};

}  // namespace skein::same_host
