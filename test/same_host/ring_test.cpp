#include "same_host/ring.hpp"

#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstring>
#include <deque>
#include <random>
#include <thread>
#include <vector>

#include "same_host/shared_memory.hpp"
#include "test/tools/one_core.hpp"

using namespace skein;
using namespace skein::same_host;
using namespace std::chrono_literals;

namespace {

constexpr std::size_t kLargest = 1 << 20;

/// A ring of this process alone.
struct Memory {
  explicit Memory(std::size_t capacity) : content(capacity / 8) {}
  RingPlace place() {
    return {&state, reinterpret_cast<std::byte*>(content.data()), content.size() * 8};
  }
  void set_header(std::size_t offset, std::uint32_t kind, std::uint32_t size) {
    content[offset / 8] = std::uint64_t{kind} << 32 | size;
  }

  RingState state;
  std::vector<std::uint64_t> content;
};

std::vector<std::byte> message(std::size_t size, std::size_t seed) {
  std::vector<std::byte> content(size);
  for (std::size_t i = 0; i < size; ++i) content[i] = static_cast<std::byte>(seed * 31 + i * 7);
  return content;
}

bool equal(std::span<const std::byte> one, std::span<const std::byte> other) {
  return std::ranges::equal(one, other);
}

/// What takes a message out at a time, and sleeps when there is none.
bool take_one(RingReader& reader, Bytes& content, Instant deadline) {
  while (!reader.take(content)) {
    if (std::chrono::steady_clock::now() >= deadline) return false;
    if (!reader.prepare_to_sleep(RingReader::Who::Caller)) continue;
    futex_wait(reader.word(RingReader::Who::Caller), 1, deadline);
    reader.stay_awake(RingReader::Who::Caller);
  }
  return true;
}

bool never() { return false; }

const FileDescriptor kNoDoorbell;

Instant soon() { return std::chrono::steady_clock::now() + 20s; }

}  // namespace

TEST_CASE("messages of every size arrive whole and in order, also those longer than the ring") {
  Memory memory(GENERATE(4096u, 65'536u));
  RingWriter writer(memory.place(), kNoDoorbell);
  RingReader reader(memory.place(), kLargest);
  Bytes taken;
  std::size_t seed = 0;
  for (int round = 0; round < 20; ++round) {
    for (const std::size_t size :
         {0u, 1u, 7u, 8u, 9u, 64u, 1000u, 4088u, 4096u, 40'000u, 300'000u}) {
      CAPTURE(size, round);
      const auto sent = message(size, ++seed);
      RingWriter::Part part{sent};
      bool whole = false;
      while (!writer.put(part)) {
        whole = reader.take(taken);
        REQUIRE_FALSE(whole);
      }
      while (!whole) whole = reader.take(taken);
      REQUIRE(equal(taken, sent));
    }
  }
  CHECK_FALSE(reader.ready());
}

TEST_CASE("a reader that sleeps on the writer's core is woken when it has much to do, or all") {
  constexpr std::size_t kSize = 16 << 20;
  constexpr std::size_t kCapacity = 256 << 10;
  const test::OneCore one_core;
  Memory memory(kCapacity);
  RingWriter writer(memory.place(), kNoDoorbell);
  RingReader reader(memory.place(), kSize);
  const auto sent = message(kSize, 1);
  Bytes taken;
  bool whole = false;
  std::thread reading([&] { whole = take_one(reader, taken, soon()); });
  CHECK(writer.write({sent}, 20s, never));
  reading.join();
  REQUIRE(whole);
  CHECK(equal(taken, sent));
  // It sleeps where the ring is empty, and is woken where that is full, or at the end.
  CHECK(writer.wakes() <= kSize / kCapacity + 1);
}

TEST_CASE("a full ring takes no more until the reader has made room") {
  Memory memory(4096);
  RingWriter writer(memory.place(), kNoDoorbell);
  RingReader reader(memory.place(), kLargest);
  std::size_t sent = 0;
  RingWriter::Part rest{};
  const auto content = message(100, 1);
  for (;; ++sent) {
    rest = {content};
    if (!writer.put(rest)) break;
  }
  CHECK(sent >= 4096 / 112 - 10);
  CHECK_FALSE(writer.put(rest));
  CHECK_FALSE(writer.write({content}, 0ms, never));
  CHECK_FALSE(writer.write({content}, 1h, [] { return true; }));
  Bytes taken;
  for (std::size_t i = 0; i < sent; ++i) REQUIRE(reader.take(taken));
  CHECK(writer.put(rest));
  CHECK(writer.await_empty(std::chrono::steady_clock::now(), never) == false);
  REQUIRE(reader.take(taken));
  CHECK(writer.await_empty(std::chrono::steady_clock::now(), never));
}

TEST_CASE("a reader that always takes something, but never enough, puts off no writer's end") {
  Memory memory(4096);
  RingWriter writer(memory.place(), kNoDoorbell);
  const auto content = message(8000, 1);
  std::atomic<bool> reading = true;
  std::thread reader([&] {
    const Instant end = soon();
    for (std::uint64_t taken = 0; reading && std::chrono::steady_clock::now() < end; taken ^= 8) {
      memory.state.read = taken;
      Word& sleeps = memory.state.writer_sleeps;
      if (sleeps.exchange(0) != 0) futex_wake(sleeps);
    }
    reading = false;
  });
  CHECK_FALSE(writer.write({content}, 50ms, never));
  CHECK(reading);
  CHECK_FALSE(writer.await_empty(std::chrono::steady_clock::now() + 50ms, never));
  CHECK(reading.exchange(false));
  reader.join();
}

TEST_CASE("a message that its writer gave up is passed over") {
  Memory memory(4096);
  RingWriter writer(memory.place(), kNoDoorbell);
  RingReader reader(memory.place(), kLargest);
  const auto given_up = message(10'000, 1);
  RingWriter::Part part{given_up};
  REQUIRE_FALSE(writer.put(part));
  Bytes taken;
  CHECK_FALSE(reader.take(taken));
  const auto next = message(50, 2);
  RingWriter::Part other{next};
  REQUIRE(writer.put(other));
  REQUIRE(reader.take(taken));
  CHECK(equal(taken, next));
}

TEST_CASE(
    "the kernel is asked once to wake a reader that sleeps, and never for one that is awake") {
  Memory memory(4096);
  RingWriter writer(memory.place(), kNoDoorbell);
  RingReader reader(memory.place(), kLargest);
  Bytes taken;
  const auto put = [&] {
    const auto content = message(8, 1);
    RingWriter::Part part{content};
    return writer.put(part);
  };
  for (int i = 0; i < 1000; ++i) {
    REQUIRE(put());
    REQUIRE(reader.take(taken));
  }
  CHECK(writer.wakes() == 0);
  REQUIRE(reader.prepare_to_sleep());
  REQUIRE(put());
  CHECK(writer.wakes() == 1);
  CHECK(reader.word() == 0);
  REQUIRE(put());
  CHECK(writer.wakes() == 1);
  CHECK_FALSE(reader.prepare_to_sleep());
  CHECK(reader.word() == 0);
}

TEST_CASE("a ring that is empty is used from its beginning again: small messages touch few pages") {
  constexpr std::size_t kPage = 4096 / sizeof(std::uint64_t);
  Memory memory(256 << 10);
  RingWriter writer(memory.place(), kNoDoorbell);
  RingReader reader(memory.place(), kLargest);
  const auto content = message(100, 1);
  Bytes taken;
  const auto put = [&] {
    RingWriter::Part part{content};
    REQUIRE(writer.put(part));
  };
  const auto take = [&] {
    REQUIRE(reader.take(taken));
    REQUIRE(equal(taken, content));
  };
  const auto pages_touched = [&] {
    std::ranges::fill(memory.content, 0);
    for (int i = 0; i < 10'000; ++i) {
      put();
      take();
    }
    const auto last = std::find_if(memory.content.rbegin(), memory.content.rend(),
                                   [](std::uint64_t octets) { return octets != 0; });
    return static_cast<std::size_t>(memory.content.rend() - last + kPage - 1) / kPage;
  };
  CHECK(pages_touched() <= 5);
  const std::size_t waiting = GENERATE(1, 7);
  for (std::size_t i = 0; i < waiting; ++i) put();
  // From here on it is never empty, and what waits is not wiped out: the writer has come round.
  for (int i = 0; i < 10'000; ++i) {
    put();
    take();
  }
  for (std::size_t i = 0; i < waiting; ++i) take();
  pages_touched();
  CHECK(pages_touched() <= 5);
}

// Each step of either side is atomic to the other one; what a thread does between them is nothing.
TEST_CASE("in every order of steps nobody sleeps while there is something to do") {
  const auto seed = GENERATE(range(0u, 50u));
  std::mt19937 random(seed);
  Memory memory(4096);
  RingWriter writer(memory.place(), kNoDoorbell);
  RingReader reader(memory.place(), kLargest);
  std::deque<std::vector<std::byte>> expected;
  std::vector<std::byte> sending;
  RingWriter::Part part{};
  bool under_way = false;
  Bytes taken;
  std::size_t sent = 0;
  const auto reader_sleeps = [&] { return reader.word() == 1; };
  const auto writer_sleeps = [&] { return memory.state.writer_sleeps == 1; };
  for (int step = 0; step < 20'000; ++step) {
    switch (random() % 4) {
      case 0:
        if (writer_sleeps()) break;
        if (!under_way) {
          sending = message(random() % (random() % 10 == 0 ? 9000 : 200), ++sent);
          expected.push_back(sending);
          part = {expected.back()};
        }
        under_way = !writer.put(part);
        break;
      case 1:
        if (reader_sleeps() || !reader.take(taken)) break;
        REQUIRE_FALSE(expected.empty());
        REQUIRE(equal(taken, expected.front()));
        expected.pop_front();
        break;
      case 2:
        if (!reader_sleeps()) reader.prepare_to_sleep();
        break;
      case 3:
        if (under_way && !writer_sleeps()) writer.prepare_to_sleep();
        break;
    }
    if (reader_sleeps()) REQUIRE_FALSE(reader.ready());
    REQUIRE_FALSE((reader_sleeps() && writer_sleeps()));
  }
  CHECK(sent > 1000);
}

TEST_CASE("what is damaged is named, and nothing outside the ring is touched") {
  Memory memory(4096);
  RingWriter writer(memory.place(), kNoDoorbell);
  RingReader reader(memory.place(), 1000);
  Bytes taken;
  const auto refuses = [&](const std::string& why) {
    CHECK_THROWS_AS(reader.take(taken), BrokenRing);
    CHECK_THROWS_WITH(reader.take(taken), Catch::Contains(why));
  };
  SECTION("the writer's position") {
    memory.state.written = GENERATE(4104u, 12u);
    refuses("the writer's position is");
  }
  SECTION("that it goes back") {
    memory.state.written = ~std::uint64_t{7};
    refuses("the writer's position is -8 octets from this side's, in a ring of 4096");
  }
  SECTION("the reader's position") {
    const auto content = message(5000, 1);
    RingWriter::Part part{content};
    REQUIRE_FALSE(writer.put(part));
    memory.state.read = memory.state.written + 8;
    CHECK_THROWS_WITH(writer.put(part), Catch::Contains("the reader's position is -8"));
  }
  SECTION("a length beyond what was written") {
    memory.state.written = 16;
    memory.set_header(0, 3, GENERATE(9u, 4096u, 0xFFFF'FFFFu));
    refuses("of which 16 can be there");
  }
  SECTION("a kind") {
    memory.state.written = 16;
    memory.set_header(0, GENERATE(5u, 8u, 0xFFFF'FFFFu), 8);
    refuses("a frame of an unknown kind");
  }
  SECTION("a gap with content") {
    memory.state.written = 4096;
    memory.set_header(0, 4, 8);
    refuses("a frame of an unknown kind, 4");
  }
  SECTION("a gap that was not written") {
    memory.state.written = 8;
    memory.set_header(0, 4, 0);
    refuses("a frame of 4096 octets, of which 8 can be there");
  }
  SECTION("a message that has no beginning") {
    memory.state.written = 16;
    memory.set_header(0, GENERATE(0u, 2u), 8);
    refuses("goes on without having begun");
  }
  SECTION("a message that is too long") {
    memory.state.written = 2048;
    memory.set_header(0, 1, 992);
    memory.set_header(1000, 2, 16);
    CHECK_THROWS_WITH(reader.take(taken), Catch::Contains("a message of more than 1000 octets"));
  }
}

TEST_CASE("whatever a hostile peer writes, a reader and a writer end, inside the ring") {
  std::mt19937_64 random(4711);
  std::size_t broken = 0;
  std::size_t whole = 0;
  for (int round = 0; round < 20'000; ++round) {
    Memory memory(512);
    RingWriter writer(memory.place(), kNoDoorbell);
    RingReader reader(memory.place(), 1000);
    Bytes taken;
    try {
      for (int step = 0; step < 20; ++step) {
        for (auto& word : memory.content) {
          word = (random() % 6) << 32 | random() % (random() % 8 == 0 ? 1000 : 64);
        }
        if (random() % 8 == 0) memory.content[0] = random();
        memory.state.written += random() % 16 == 0 ? random() : random() % 64 * 8;
        if (random() % 16 == 0) memory.state.read = random();
        whole += reader.take(taken);
        REQUIRE(taken.size() <= 1000);
        const auto content = message(random() % 600, 1);
        RingWriter::Part part{content};
        writer.put(part);
      }
    } catch (const BrokenRing&) {
      ++broken;
    }
  }
  CHECK(broken > 10'000);
  CHECK(whole > 1'000);
}

TEST_CASE("two threads that both sleep when they must lose nothing") {
  Memory memory(4096);
  constexpr std::size_t kMessages = 20'000;
  std::thread sender([&] {
    RingWriter writer(memory.place(), kNoDoorbell);
    std::mt19937 random(1);
    for (std::size_t i = 0; i < kMessages; ++i) {
      writer.write({message(random() % (i % 100 == 0 ? 20'000 : 300), i)}, 20s, never);
    }
  });
  RingReader reader(memory.place(), kLargest);
  std::mt19937 random(1);
  Bytes taken;
  std::size_t right = 0;
  for (std::size_t i = 0; i < kMessages; ++i) {
    if (!take_one(reader, taken, soon())) break;
    right += equal(taken, message(random() % (i % 100 == 0 ? 20'000 : 300), i));
  }
  sender.join();
  CHECK(right == kMessages);
}

TEST_CASE("a process answers another one through two rings, and nobody's sleep is forgotten") {
  constexpr std::size_t kCapacity = 8192;
  constexpr std::size_t kMessages = 5'000;
  const auto made = SharedMemory::make(4096 + 2 * kCapacity);
  const auto place = [](const SharedMemory& memory, std::size_t which) {
    return RingPlace{reinterpret_cast<RingState*>(memory.data()) + which,
                     memory.data() + 4096 + which * kCapacity, kCapacity};
  };
  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    const auto mapped = SharedMemory::map(FileDescriptor(dup(made.descriptor())), made.size());
    RingReader requests(place(mapped, 0), kLargest);
    RingWriter replies(place(mapped, 1), kNoDoorbell);
    Bytes taken;
    for (std::size_t i = 0; i < kMessages; ++i) {
      if (!take_one(requests, taken, soon()) || !replies.write({taken}, 20s, never)) _exit(1);
    }
    _exit(0);
  }
  RingWriter requests(place(made, 0), kNoDoorbell);
  RingReader replies(place(made, 1), kLargest);
  std::size_t right = 0;
  Bytes taken;
  for (std::size_t i = 0; i < kMessages; ++i) {
    const auto sent = message(i % 50 == 0 ? 30'000 : i % 200, i);
    if (!requests.write({sent}, 20s, never) || !take_one(replies, taken, soon())) break;
    right += equal(taken, sent);
  }
  int status = 0;
  REQUIRE(waitpid(child, &status, 0) == child);
  CHECK(status == 0);
  CHECK(right == kMessages);
}

TEST_CASE("shared memory is neither shortened nor lengthened, and is refused where it could be") {
  const auto made = SharedMemory::make(8192);
  CHECK(ftruncate(made.descriptor(), 4096) != 0);
  CHECK(ftruncate(made.descriptor(), 16'384) != 0);
  CHECK_THROWS_WITH(SharedMemory::map(FileDescriptor(dup(made.descriptor())), 4096),
                    Catch::Contains("offers 8192 octets; 4096 are needed"));
  FileDescriptor unsealed(memfd_create("test", MFD_CLOEXEC | MFD_ALLOW_SEALING));
  REQUIRE(ftruncate(unsealed.get(), 8192) == 0);
  CHECK_THROWS_WITH(SharedMemory::map(std::move(unsealed), 8192), Catch::Contains("is not sealed"));
  int ends[2];
  REQUIRE(pipe(ends) == 0);
  const FileDescriptor other(ends[1]);
  CHECK_THROWS_AS(SharedMemory::map(FileDescriptor(ends[0]), 8192), Unavailable);
}
