#include <catch2/catch.hpp>

#include "dds/port/port.hpp"
#include "skein/error.hpp"
#include "skein/loopback.hpp"

using namespace skein;
using namespace skein::dds;
using namespace std::chrono_literals;

namespace {

const Topic kTopic{"counts", "test::Count", false};

/// A sample whose body is one number.
std::vector<std::byte> number(std::uint8_t value) {
  return {std::byte{0}, std::byte{1}, std::byte{0}, std::byte{0}, std::byte{value}};
}

std::vector<int> take_all(Reader& reader) {
  std::vector<int> values;
  reader.take([&](const Sample& sample) { values.push_back(std::to_integer<int>(sample.cdr[4])); });
  return values;
}

struct Peer {
  Peer(LoopbackNetwork& network, std::chrono::milliseconds lease = 1000ms) {
    ParticipantOptions options;
    options.lease = lease;
    options.on_participant = [this](const Guid&, bool present) {
      events.push_back(present ? '+' : '-');
    };
    participant = network.vendor()->create_participant(options);
  }
  std::string events;
  std::unique_ptr<Participant> participant;
};

struct Pair {
  explicit Pair(Qos qos = {}) {
    writer = one.participant->create_writer(kTopic, qos);
    ReaderListener listener;
    listener.on_matched = [this](const Guid&, bool matched) { events += matched ? "+" : "-"; };
    listener.on_liveliness = [this](const Guid&, bool alive) {
      events += alive ? "alive " : "lost ";
    };
    reader = two.participant->create_reader(kTopic, qos, listener);
  }
  ManualClock clock;
  LoopbackNetwork network{clock};
  Peer one{network};
  Peer two{network};
  std::string events;
  std::unique_ptr<Writer> writer;
  std::unique_ptr<Reader> reader;
};

}  // namespace

TEST_CASE_METHOD(Pair, "a sample is there when write returns, without any thread") {
  writer->write(number(7));
  CHECK(take_all(*reader) == std::vector{7});
  CHECK(writer->wait_for_acknowledgments(0ms));
}

TEST_CASE_METHOD(Pair, "a reliable reader gets what was lost after the repeat time, in order") {
  network.judge_transfers([](const Transfer& transfer) {
    return transfer.sequence == 2 && transfer.attempt < 3 ? Fate::drop() : Fate::deliver();
  });
  for (int i = 1; i <= 3; ++i) writer->write(number(static_cast<std::uint8_t>(i)));
  CHECK(take_all(*reader) == std::vector{1});
  CHECK_FALSE(writer->wait_for_acknowledgments(0ms));
  clock.advance(LoopbackNetwork::kRepeatAfter);
  CHECK(take_all(*reader).empty());
  clock.advance(LoopbackNetwork::kRepeatAfter);
  CHECK(take_all(*reader) == std::vector{2, 3});
  CHECK(writer->wait_for_acknowledgments(0ms));
}

TEST_CASE_METHOD(Pair, "a reliable reader sees neither duplicates nor a wrong order") {
  network.judge_transfers([](const Transfer& transfer) {
    return transfer.sequence == 1 ? Fate::late(5ms) : Fate::twice();
  });
  writer->write(number(1));
  writer->write(number(2));
  CHECK(take_all(*reader).empty());
  clock.advance(5ms);
  CHECK(take_all(*reader) == std::vector{1, 2});
}

TEST_CASE("a best-effort reader loses what is dropped and what comes late") {
  Qos qos;
  qos.reliable = false;
  Pair pair(qos);
  pair.network.judge_transfers([](const Transfer& transfer) {
    if (transfer.sequence == 1) return Fate::late(5ms);
    return transfer.sequence == 2 ? Fate::drop() : Fate::deliver();
  });
  for (int i = 1; i <= 3; ++i) pair.writer->write(number(static_cast<std::uint8_t>(i)));
  pair.clock.advance(1s);
  CHECK(take_all(*pair.reader) == std::vector{3});
}

TEST_CASE("an isolated participant is gone after its lease and comes back with heal") {
  Qos qos;
  qos.liveliness_lease = 200ms;
  Pair pair(qos);
  CHECK(pair.two.events == "+");
  pair.network.isolate(pair.one.participant->guid());
  pair.clock.advance(199ms);
  CHECK(pair.events == "+");
  pair.clock.advance(1ms);
  CHECK(pair.events == "+lost ");
  pair.clock.advance(800ms);
  CHECK(pair.two.events == "+-");
  CHECK(pair.one.events == "+-");
  CHECK(pair.reader->matched_writers().empty());
  CHECK(pair.writer->matched_readers().empty());
  pair.network.heal();
  CHECK(pair.two.events == "+-+");
  CHECK(pair.events == "+lost -+");
  pair.writer->write(number(9));
  CHECK(take_all(*pair.reader) == std::vector{9});
}

TEST_CASE("what was written during a short cut arrives with heal") {
  Qos qos;
  qos.liveliness_lease = 200ms;
  Pair pair(qos);
  pair.network.separate(pair.one.participant->guid(), pair.two.participant->guid());
  pair.writer->write(number(1));
  pair.clock.advance(500ms);
  CHECK(take_all(*pair.reader).empty());
  pair.network.heal();
  CHECK(take_all(*pair.reader) == std::vector{1});
  CHECK(pair.events == "+lost alive ");
}

TEST_CASE("an endpoint that was removed during a cut is told nothing, and is forgotten with heal") {
  Qos qos;
  qos.liveliness_lease = 200ms;
  Pair pair(qos);
  pair.network.separate(pair.one.participant->guid(), pair.two.participant->guid());
  pair.clock.advance(300ms);
  const std::string removed = GENERATE("reader", "writer");
  if (removed == "reader") pair.reader.reset();
  if (removed == "writer") pair.writer.reset();
  CHECK(pair.events == "+lost ");
  pair.network.heal();
  if (removed == "reader") CHECK(pair.writer->matched_readers().empty());
  if (removed == "writer") CHECK(pair.reader->matched_writers().empty());
  CHECK(pair.events == (removed == "reader" ? "+lost " : "+lost -"));
}

TEST_CASE_METHOD(Pair, "a paused participant loses nobody, but is lost and found again") {
  network.pause(two.participant->guid());
  clock.advance(1s);
  CHECK(one.events == "+-");
  CHECK(two.events == "+");
  network.resume(two.participant->guid());
  CHECK(one.events == "+-+");
  CHECK(two.events == "+");
  writer->write(number(4));
  CHECK(take_all(*reader) == std::vector{4});
}

TEST_CASE_METHOD(Pair, "what is sent to a paused participant waits for it") {
  network.pause(two.participant->guid());
  writer->write(number(1));
  clock.advance(900ms);
  CHECK(take_all(*reader).empty());
  network.resume(two.participant->guid());
  CHECK(take_all(*reader) == std::vector{1});
  CHECK(one.events == "+");
}

TEST_CASE_METHOD(Pair, "a killed participant says no goodbye and never returns") {
  network.kill(one.participant->guid());
  writer.reset();
  clock.advance(999ms);
  CHECK(events == "+");
  clock.advance(1ms);
  CHECK(events == "+-");
  CHECK(two.events == "+-");
  network.heal();
  CHECK(two.events == "+-");
}

TEST_CASE("transient-local samples come back after a long cut") {
  Qos qos;
  qos.transient_local = true;
  qos.history_depth = 1;
  Pair pair(qos);
  pair.writer->write(number(1));
  pair.writer->write(number(2));
  CHECK(take_all(*pair.reader) == std::vector{2});
  pair.network.isolate(pair.one.participant->guid());
  pair.clock.advance(2s);
  pair.network.heal();
  CHECK(take_all(*pair.reader) == std::vector{2});
}

TEST_CASE("a full writer refuses at once where time stands still") {
  Qos qos;
  qos.max_samples = 2;
  Pair pair(qos);
  pair.network.isolate(pair.two.participant->guid());
  pair.writer->write(number(1));
  pair.writer->write(number(2));
  CHECK_THROWS_AS(pair.writer->write(number(3)), Overloaded);
  pair.clock.advance(1s);
  CHECK_NOTHROW(pair.writer->write(number(4)));
}

TEST_CASE("a listener's write that finds no room is refused at once, and waits for nobody") {
  SystemClock clock;
  LoopbackNetwork network(clock);
  Peer one(network, 10min);
  Peer two(network, 10min);
  Qos qos;
  qos.max_samples = 1;
  qos.max_blocking = 10min;
  const auto writer = one.participant->create_writer(kTopic, qos);
  const auto far = two.participant->create_reader(kTopic, qos);
  network.isolate(two.participant->guid());
  writer->write(number(1));

  const Topic bell{"bell", "test::Count", false};
  bool refused = false;
  ReaderListener listener;
  listener.on_data = [&](Reader&) {
    try {
      writer->write(number(2));
    } catch (const Overloaded&) {
      refused = true;
    }
  };
  const auto ears = one.participant->create_reader(bell, Qos{}, listener);
  const auto hand = one.participant->create_writer(bell, Qos{});
  hand->write(number(3));
  CHECK(refused);
}

TEST_CASE("an owner that is silent for its lease hands over, and takes again when it is back") {
  Qos qos;
  qos.exclusive = true;
  qos.strength = 2;
  qos.liveliness_lease = 200ms;
  Pair pair(qos);
  Peer third(pair.network);
  qos.strength = 1;
  const auto weak = third.participant->create_writer(kTopic, qos);
  weak->write(number(1));
  pair.writer->write(number(2));
  weak->write(number(3));
  CHECK(take_all(*pair.reader) == std::vector{1, 2});
  pair.network.pause(pair.one.participant->guid());
  pair.clock.advance(199ms);
  weak->write(number(4));
  CHECK(take_all(*pair.reader).empty());
  pair.clock.advance(1ms);
  weak->write(number(5));
  CHECK(take_all(*pair.reader) == std::vector{5});
  pair.network.resume(pair.one.participant->guid());
  pair.writer->write(number(6));
  weak->write(number(7));
  CHECK(take_all(*pair.reader) == std::vector{6});
}

TEST_CASE("two runs see the same GUIDs") {
  Pair first;
  Pair second;
  CHECK(first.writer->guid() == second.writer->guid());
  CHECK(first.reader->guid() == second.reader->guid());
}
