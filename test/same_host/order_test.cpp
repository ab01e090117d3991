// Two threads hammer each structure that synchronises without a lock, in the two ways in which a
// processor that reorders memory accesses breaks it. Message passing: one side writes content, then
// that it is there. Store buffering: one side writes that there is something, then looks whether
// the other sleeps; that one writes that it sleeps, then looks whether there is something.
#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <cstdint>
#include <thread>
#include <vector>

#include "same_host/doorbell.hpp"
#include "same_host/lead.hpp"
#include "same_host/ring.hpp"
#include "test/tools/eventually.hpp"

using namespace skein;
using namespace skein::same_host;

namespace {

constexpr std::size_t kSmall = 4096;
const FileDescriptor kSilent;

Instant limit() { return std::chrono::steady_clock::now() + test::kPatience; }
bool never() { return false; }

/// A ring so small that its octets are used again and again.
struct SmallRing {
  RingPlace place() { return {&state, reinterpret_cast<std::byte*>(content.data()), kSmall}; }

  RingState state;
  std::vector<std::uint64_t> content = std::vector<std::uint64_t>(kSmall / 8);
  RingWriter writer{place(), kSilent};
  RingReader reader{place(), std::size_t{1} << 20};
};

/// Message `number`: its number, as often as its number says.
std::span<const std::byte> make_message(std::vector<std::uint32_t>& content, std::uint32_t number) {
  content.assign(1 + number % 61, number);
  return std::as_bytes(std::span(content));
}

bool is_message(std::span<const std::byte> message, std::uint32_t number) {
  std::vector<std::uint32_t> expected;
  return std::ranges::equal(message, make_message(expected, number));
}

/// Waits for a message asleep. False if nobody wakes it.
bool take_asleep(RingReader& reader, Bytes& message) {
  while (!reader.take(message)) {
    if (!reader.prepare_to_sleep(RingReader::Who::Caller)) continue;
    const Instant end = limit();
    futex_wait(reader.word(RingReader::Who::Caller), 1, end);
    reader.stay_awake(RingReader::Who::Caller);
    if (std::chrono::steady_clock::now() >= end) return false;
  }
  return true;
}

/// Lets two threads begin each round at once, and tells each of the other's end of it.
class Rounds {
 public:
  void meet() {
    const std::uint32_t mine = ++arrived_;
    const std::uint32_t both = (mine + 1) / 2 * 2;
    while (arrived_ < both) std::this_thread::yield();
  }

 private:
  std::atomic<std::uint32_t> arrived_{0};
};

}  // namespace

TEST_CASE("a reader that sees that a message is there sees its content, wherever the ring is") {
  constexpr std::uint32_t kMessages = 100'000;
  SmallRing ring;
  std::thread writing([&] {
    std::vector<std::uint32_t> content;
    for (std::uint32_t i = 0; i < kMessages; ++i) {
      RingWriter::Part part{make_message(content, i)};
      while (!ring.writer.put(part)) std::this_thread::yield();
    }
  });
  Bytes message;
  std::uint32_t wrong = 0;
  for (std::uint32_t i = 0; i < kMessages; ++i) {
    while (!ring.reader.take(message)) std::this_thread::yield();
    if (!is_message(message, i)) ++wrong;
  }
  writing.join();
  CHECK(wrong == 0);
}

TEST_CASE("a reader that falls asleep while a message is put in is woken") {
  constexpr std::uint32_t kRounds = 20'000;
  SmallRing there;
  SmallRing back;
  std::atomic<bool> lost = false;
  const auto play = [&](SmallRing& out, SmallRing& in, bool begins) {
    std::vector<std::uint32_t> content;
    Bytes message;
    for (std::uint32_t i = 0; i < kRounds && !lost; ++i) {
      RingWriter::Part part{make_message(content, i)};
      if (begins && !out.writer.put(part)) lost = true;
      if (!take_asleep(in.reader, message) || !is_message(message, i)) lost = true;
      if (!begins && !out.writer.put(part)) lost = true;
    }
  };
  std::thread other([&] { play(back, there, false); });
  play(there, back, true);
  other.join();
  CHECK_FALSE(lost);
}

TEST_CASE("a writer that falls asleep while room is made is woken") {
  constexpr std::uint32_t kMessages = 2'000;
  const std::vector<std::byte> content(4 * kSmall, std::byte{7});
  SmallRing ring;
  std::atomic<bool> lost = false;
  std::thread writing([&] {
    for (std::uint32_t i = 0; i < kMessages && !lost; ++i) {
      if (!ring.writer.write({content}, test::kPatience, never)) lost = true;
    }
  });
  Bytes message;
  for (std::uint32_t i = 0; i < kMessages && !lost; ++i) {
    while (!lost && !ring.reader.take(message)) std::this_thread::yield();
    if (!lost && !std::ranges::equal(std::span<const std::byte>(message), content)) lost = true;
  }
  writing.join();
  CHECK_FALSE(lost);
}

TEST_CASE("a message put in while a caller takes its leave is seen by it, or the reader is woken") {
  constexpr std::uint32_t kRounds = 20'000;
  SmallRing ring;
  Rounds rounds;
  std::uint32_t lost = 0;
  std::thread writing([&] {
    std::vector<std::uint32_t> content;
    for (std::uint32_t i = 0; i < kRounds; ++i) {
      RingWriter::Part part{make_message(content, i)};
      rounds.meet();
      if (!ring.writer.put(part)) ++lost;
      rounds.meet();
    }
  });
  Bytes message;
  for (std::uint32_t i = 0; i < kRounds; ++i) {
    ring.reader.lend();
    ring.reader.prepare_to_sleep();
    rounds.meet();
    const bool seen = ring.reader.take_back();
    rounds.meet();
    const bool woken = ring.reader.word() == 0;
    if (!seen && !woken) ++lost;
    if (!ring.reader.take(message) || !is_message(message, i)) ++lost;
    ring.reader.stay_awake();
  }
  writing.join();
  CHECK(lost == 0);
}

TEST_CASE("a thread that falls asleep at its doorbells while it is called is woken") {
  constexpr std::uint32_t kRounds = 20'000;
  Doorbells doorbells;
  const FileDescriptor doorbell = make_doorbell();
  doorbells.add(doorbell, 1);
  doorbells.wait(std::chrono::milliseconds(0));  // it has rung, being new
  std::atomic<std::uint32_t> asked{0};
  std::atomic<std::uint32_t> answered{0};
  std::atomic<bool> lost = false;
  std::thread calling([&] {
    for (std::uint32_t i = 1; i <= kRounds && !lost; ++i) {
      asked = i;
      doorbells.call();
      while (answered < i && !lost) std::this_thread::yield();
    }
  });
  for (std::uint32_t i = 1; i <= kRounds && !lost; ++i) {
    const Instant end = limit();
    while (true) {
      doorbells.forget_call();
      if (asked >= i) break;
      doorbells.wait(test::kPatience);
      if (std::chrono::steady_clock::now() >= end) lost = true;
      if (lost) break;
    }
    answered = i;
  }
  calling.join();
  CHECK_FALSE(lost);
}

TEST_CASE("who takes the lead sees what the one before it has done, and is woken when it is free") {
  constexpr std::uint32_t kRounds = 5'000;
  Lead lead;
  std::uint64_t led = 0;  // by who has the lead
  std::atomic<std::uint32_t> stood_by = 0;
  const auto stopping = [end = limit()] { return std::chrono::steady_clock::now() >= end; };
  std::thread standing([&] {
    for (std::uint32_t i = 0; i < kRounds && lead.stand_by(stopping); ++i) {
      ++led;
      ++stood_by;
      lead.give_up();
    }
  });
  std::uint64_t others = 0;
  while (stood_by < kRounds && !stopping()) {
    if (lead.take()) {
      ++led;
      ++others;
      lead.give_up();
    }
    std::this_thread::yield();
  }
  standing.join();
  CHECK(stood_by == kRounds);
  CHECK(led == kRounds + others);
}
