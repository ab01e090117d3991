// The mission's time over topics: a keeper and participants, each an entity of its own, on the
// loopback network in real time.
#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <stop_token>
#include <thread>
#include <utility>
#include <vector>

#include "entities/mission_participant.hpp"
#include "entities/stream.hpp"
#include "entities/time_keeper.hpp"
#include "flight.idl.hpp"
#include "skein/error.hpp"
#include "skein/loopback.hpp"

namespace time_test {

using namespace reconnaissance;
using namespace std::chrono_literals;

namespace {

// A test that waits longer has failed.
constexpr auto kLimit = 20s;
constexpr StreamTopic kTruthEachTick{"truth", 1};

/// What happens is noted, and awaited.
class Notes {
 public:
  void note(const std::string& who, Tick tick) {
    {
      std::lock_guard lock(mutex_);
      notes_.emplace_back(who, tick);
    }
    changed_.notify_all();
  }

  bool await(const std::string& who, Tick tick) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, kLimit, [&] {
      return std::ranges::any_of(
          notes_, [&](const auto& note) { return note.first == who && note.second >= tick; });
    });
  }

  /// Of what nobody notes.
  template <class Condition>
  bool eventually(const Condition& condition) {
    const auto limit = std::chrono::steady_clock::now() + kLimit;
    std::unique_lock lock(mutex_);
    while (!condition()) {
      if (std::chrono::steady_clock::now() > limit) return false;
      changed_.wait_for(lock, 1ms);
    }
    return true;
  }

  std::vector<Tick> of(const std::string& who) {
    std::lock_guard lock(mutex_);
    std::vector<Tick> ticks;
    for (const auto& [name, tick] : notes_)
      if (name == who) ticks.push_back(tick);
    return ticks;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::pair<std::string, Tick>> notes_;
};

std::unique_ptr<skein::Entity> make_entity(
    const std::string& name,
    std::shared_ptr<skein::dds::Vendor> vendor = skein::dds::load_vendor("loopback")) {
  return std::make_unique<skein::Entity>(
      skein::EntityOptions{.name = name, .vendor = std::move(vendor)});
}

/// One with a process of its own, as it were.
struct Member {
  Member(const std::string& name, int rate_hz, Participant::Work work,
         std::shared_ptr<skein::dds::Vendor> vendor = skein::dds::load_vendor("loopback"))
      : entity(make_entity(name, std::move(vendor))),
        participant(std::make_unique<Participant>(*entity, rate_hz, std::move(work))) {
    participant->start();
  }
  ~Member() { participant.reset(); }

  std::unique_ptr<skein::Entity> entity;
  std::unique_ptr<Participant> participant;
};

/// The keeper of time, with a thread that lets it pass.
struct Simulator {
  explicit Simulator(
      std::size_t expected, Notes& notes_,
      std::shared_ptr<skein::dds::Vendor> vendor = skein::dds::load_vendor("loopback"),
      skein::Duration patience = TimeKeeper::kPatience)
      : entity(make_entity("simulator", std::move(vendor))),
        time(*entity, expected, 0, {}, patience),
        notes(notes_) {
    truth.emplace(entity->publisher<recon::Truth>(kTruthEachTick.name, stream_qos()));
    thread = std::jthread([this](const std::stop_token& stop) {
      while (const auto tick = time.await_next(stop)) {
        recon::Truth sample;
        sample.tick = *tick;
        truth->publish(sample);
        notes.note("simulator", *tick);
        time.begin(*tick);
      }
    });
  }

  std::unique_ptr<skein::Entity> entity;
  TimeKeeper time;
  Notes& notes;
  std::optional<skein::Publisher<recon::Truth>> truth;
  std::jthread thread;
};

bool is_complete(const std::vector<Tick>& ticks, int period) {
  for (std::size_t i = 0; i < ticks.size(); ++i)
    if (ticks[i] != static_cast<Tick>(i) * period) return false;
  return !ticks.empty();
}

}  // namespace

TEST_CASE("each takes part in exactly the ticks of its rate, in step with all others") {
  Notes notes;
  std::atomic<bool> ahead = false;
  Simulator simulator(2, notes);
  Member controller("controller", 50, [&](Tick tick) { notes.note("controller", tick); });
  Member navigator("navigator", 10, [&](Tick tick) {
    if (simulator.time.tick() != tick) ahead = true;  // time stands while it works
    notes.note("navigator", tick);
  });
  REQUIRE(notes.await("navigator", 500));
  simulator.time.pause();
  CHECK(is_complete(notes.of("controller"), 1));
  CHECK(is_complete(notes.of("navigator"), 5));
  CHECK_FALSE(ahead);
}

TEST_CASE("a stream has the sample of the tick that is worked on") {
  Notes notes;
  Simulator simulator(1, notes);
  const auto entity = make_entity("reader");
  Stream<recon::Truth> truth(*entity, kTruthEachTick);
  std::atomic<int> others = 0;
  Participant reader(*entity, 50, [&](Tick tick) {
    const auto sample = truth.at(tick);
    if (!sample || sample->tick != tick) ++others;
    notes.note("reader", tick);
  });
  reader.start();
  REQUIRE(notes.await("reader", 200));
  CHECK(others == 0);
  CHECK(truth.lost() == 0);
}

TEST_CASE("a stream that lost a sample says so, and has the one before") {
  const auto entity = make_entity("source");
  auto samples = entity->publisher<recon::Truth>(kTruthEachTick.name, stream_qos());
  const auto other = make_entity("sink");
  Stream<recon::Truth> truth(*other, kTruthEachTick);
  CHECK_FALSE(truth.at(3, 0ms));
  recon::Truth sample;
  sample.tick = 4;
  std::optional<recon::Truth> found;
  for (int i = 0; i < 100 && !found; ++i) {
    samples.publish(sample);
    found = truth.at(4, 100ms);
  }
  REQUIRE(found);
  CHECK(truth.at(5, 1ms)->tick == 4);
  CHECK(truth.lost() >= 2);
}

TEST_CASE("who reads a stream of ten samples a second once a second has all of them") {
  constexpr StreamTopic kTenASecond{"often", 5};
  Notes notes;
  const auto entity = make_entity("source");
  auto samples = entity->publisher<recon::Truth>(kTenASecond.name);
  const auto other = make_entity("sink");
  Stream<recon::Truth> truth(*other, kTenASecond, {});
  REQUIRE(notes.eventually([&] { return samples.subscribers() == 1; }));
  recon::Truth sample;
  for (sample.tick = 5; sample.tick <= 60; sample.tick += 5) samples.publish(sample);
  REQUIRE(truth.at(60, kLimit));
  CHECK(truth.take(50).size() == 10);
  CHECK(truth.take(100).size() == 2);
}

TEST_CASE("time waits for one that works, and goes on without one that leaves") {
  Notes notes;
  std::mutex working;
  working.lock();
  Simulator simulator(2, notes);
  Member controller("controller", 50, [&](Tick tick) { notes.note("controller", tick); });
  {
    Member navigator("navigator", 10, [&](Tick tick) {
      if (tick == 10) {
        notes.note("navigator", tick);
        std::lock_guard wait(working);
      }
    });
    REQUIRE(notes.await("navigator", 10));
    REQUIRE(notes.await("controller", 10));
    CHECK(notes.eventually(
        [&] { return simulator.time.awaited() == std::vector<std::string>{"navigator"}; }));
    CHECK(simulator.time.tick() == 10);
    working.unlock();
    REQUIRE(notes.await("controller", 30));
  }
  const Tick left = simulator.time.tick();
  REQUIRE(notes.await("controller", left + 50));
  CHECK(simulator.time.participants() == 1);
}

TEST_CASE("those of several systems take part in one time, and hear nothing of others") {
  Notes notes;
  const auto in = [](const std::string& system, const std::string& name) {
    return std::make_unique<skein::Entity>(skein::EntityOptions{
        .name = name, .system = system, .vendor = skein::dds::load_vendor("loopback")});
  };
  const auto keeper = in("uav-1", "simulator"), one = in("uav-1", "navigator-1"),
             two = in("uav-2", "navigator-2"), stranger = in("uav-3", "navigator-3");
  TimeKeeper time(*keeper, 2, 0, {"uav-1", "uav-2"});
  Participant first(*one, 50, [&](Tick tick) { notes.note("first", tick); });
  Participant second(*two, 10, [&](Tick tick) { notes.note("second", tick); });
  Participant third(*stranger, 50, [&](Tick tick) { notes.note("stranger", tick); });
  third.start();
  first.start();
  second.start();
  const std::jthread passes([&](const std::stop_token& stop) {
    while (const auto tick = time.await_next(stop)) time.begin(*tick);
  });
  REQUIRE(notes.await("first", 50));
  REQUIRE(notes.await("second", 50));
  CHECK(time.participants() == 2);
  CHECK(notes.of("stranger").empty());
}

TEST_CASE("one that dies without a farewell is out, and time goes on") {
  Notes notes;
  skein::SystemClock clock;
  skein::dds::LoopbackNetwork network(clock);
  Simulator simulator(2, notes, network.vendor(), 100ms);
  Member controller(
      "controller", 50, [&](Tick tick) { notes.note("controller", tick); }, network.vendor());
  Member navigator(
      "navigator", 10, [&](Tick tick) { notes.note("navigator", tick); }, network.vendor());
  REQUIRE(notes.await("navigator", 10));
  network.kill(navigator.entity->guid());
  REQUIRE(notes.eventually([&] { return simulator.time.participants() == 1; }));
  REQUIRE(notes.await("controller", simulator.time.tick() + 50));
}

TEST_CASE("one that comes back joins at the present tick") {
  Notes notes;
  Simulator simulator(2, notes);
  Member controller("controller", 50, [&](Tick tick) { notes.note("controller", tick); });
  std::optional<Member> navigator;
  navigator.emplace("navigator", 10, [&](Tick tick) { notes.note("first", tick); });
  REQUIRE(notes.await("first", 10));
  navigator.reset();
  const Tick left = simulator.time.tick();
  REQUIRE(notes.await("controller", left + 20));
  navigator.emplace("navigator", 10, [&](Tick tick) { notes.note("second", tick); });
  REQUIRE(notes.await("second", left + 20));
  const auto ticks = notes.of("second");
  CHECK(ticks.front() >= left);
  const Tick back = simulator.time.tick();
  REQUIRE(notes.await("second", back + 50));
}

TEST_CASE("work that fails is told, and does not hold time up") {
  Notes notes;
  Simulator simulator(1, notes);
  Member navigator("navigator", 50, [&](Tick tick) {
    if (tick == 3) throw skein::InvalidArgument("a wrong turn");
  });
  REQUIRE(notes.await("simulator", 50));
}

TEST_CASE("paused time stands, and steps as many ticks as it is told") {
  Notes notes;
  Simulator simulator(1, notes);
  simulator.time.pause();
  simulator.time.step(3);
  Member navigator("navigator", 50, [&](Tick tick) { notes.note("navigator", tick); });
  REQUIRE(notes.await("navigator", 2));
  CHECK(simulator.time.tick() == 2);
  CHECK(simulator.time.pace().paused());
  simulator.time.resume();
  REQUIRE(notes.await("navigator", 10));
}

TEST_CASE("a rate that does not divide the second into ticks is refused") {
  const auto entity = make_entity("odd");
  CHECK_THROWS_AS(Participant(*entity, 7, {}), skein::InvalidArgument);
}

}  // namespace time_test
