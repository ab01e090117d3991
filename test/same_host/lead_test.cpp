#include "same_host/lead.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <thread>

#include "test/tools/eventually.hpp"

using namespace skein::same_host;
using skein::test::eventually;
using namespace std::chrono_literals;

namespace {

/// A thread that stands by until it has the lead, or is to stop.
struct StandBy {
  ~StandBy() { stop(); }
  void stop() {
    stopping = true;
    lead.wake();
    if (thread.joinable()) thread.join();
  }

  Lead& lead;
  std::atomic<bool> stopping{false};
  std::atomic<bool> has{false};
  std::thread thread{[this] { has = lead.stand_by([this] { return stopping.load(); }); }};
};

}  // namespace

TEST_CASE("one has the lead at a time, and who leaves it takes it back") {
  Lead lead;
  CHECK(lead.take());
  CHECK_FALSE(lead.take());
  const auto left = lead.leave();
  CHECK(lead.take_back(left));
  CHECK_FALSE(lead.take_back(left));
  const auto again = lead.leave();
  CHECK(lead.take());
  CHECK_FALSE(lead.take_back(again));
}

TEST_CASE("who stands by takes what was left for long, and what was given up") {
  Lead lead;
  REQUIRE(lead.take());
  const bool given_up = GENERATE(false, true);
  StandBy other{lead};
  CHECK_FALSE(eventually([&] { return other.has.load(); }, 20ms));
  std::uint64_t left = 0;
  if (given_up) {
    lead.give_up();
  } else {
    left = lead.leave();
  }
  CHECK(eventually([&] { return other.has.load(); }));
  CHECK_FALSE(lead.take_back(left));
  CHECK_FALSE(lead.take());
}

TEST_CASE("who stands by takes nothing from one who is back soon, however often it leaves") {
  Lead lead;
  REQUIRE(lead.take());
  StandBy other{lead};
  // Each time it is slow it may lose the lead, as on a busy machine.
  const auto begin = std::chrono::steady_clock::now();
  int times = 0;
  while (std::chrono::steady_clock::now() < begin + 200ms) {
    const auto before = std::chrono::steady_clock::now();
    const auto left = lead.leave();
    if (!lead.take_back(left)) {
      CHECK(std::chrono::steady_clock::now() - before >= 9ms);
      return;
    }
    ++times;
  }
  CHECK(times > 0);
  CHECK_FALSE(other.has);
}

TEST_CASE("who has stood by for long sleeps, and hears all the same") {
  Lead lead;
  REQUIRE(lead.take());
  StandBy other{lead};
  const auto long_enough = GENERATE(0ms, 200ms);
  CHECK_FALSE(eventually([&] { return other.has.load(); }, long_enough));
  SECTION("that it is to stop") {
    other.stop();
    CHECK_FALSE(other.has);
  }
  SECTION("that the lead was left") {
    lead.leave();
    CHECK(eventually([&] { return other.has.load(); }));
  }
  SECTION("that it was given up") {
    lead.give_up();
    CHECK(eventually([&] { return other.has.load(); }));
  }
}

TEST_CASE("the end waits for who has the lead, and nobody has it afterwards") {
  Lead lead;
  REQUIRE(lead.take());
  std::atomic<bool> over{false};
  std::thread ending([&] {
    lead.end();
    over = true;
  });
  CHECK_FALSE(eventually([&] { return over.load(); }, 5ms));
  const auto left = lead.leave();
  ending.join();
  CHECK_FALSE(lead.take_back(left));
  CHECK_FALSE(lead.take());
}
