#include <catch2/catch.hpp>
#include <cstdlib>
#include <map>
#include <thread>

#include "talk.hpp"
#include "test/tools/invariant.hpp"

using namespace skein;
using namespace skein::dds;
using namespace skein::dds::conformance;
using skein::test::eventually;
using namespace std::chrono_literals;

TEST_CASE_METHOD(Connected, "samples of every size arrive whole, byte for byte and in order") {
  // Bodies of 0 to 8 bytes and around: what RTPS pads must come off again.
  const std::vector<std::size_t> sizes{4,
                                       5,
                                       6,
                                       7,
                                       8,
                                       9,
                                       10,
                                       11,
                                       12,
                                       68,
                                       1027,
                                       1028,
                                       16385,
                                       63000,
                                       65000,
                                       65533,
                                       65536,
                                       70001,
                                       1u << 18,
                                       (1u << 20) + 4,
                                       (1u << 20) + 3,
                                       (4u << 20) + 1};
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    outbox.writer().write(make_sample(sizes[i], static_cast<std::uint32_t>(i)));
    INFO("size " << sizes[i]);
    REQUIRE(eventually([&] { return inbox.count() == i + 1; }));
  }
  const auto received = inbox.received();
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    INFO("size " << sizes[i]);
    CHECK(received[i].cdr.size() == sizes[i]);
    INVARIANT((received[i].cdr == make_sample(sizes[i], static_cast<std::uint32_t>(i))));
    CHECK(received[i].state == InstanceState::Alive);
    CHECK(received[i].key.is_nil());
    CHECK(received[i].writer == outbox.writer().guid());
  }
  CHECK(inbox.reader().counters().malformed == 0);
}

TEST_CASE_METHOD(Wire, "a burst of reliable samples arrives complete and in order") {
  Qos qos = keep_all();
  qos.max_blocking = 5s;
  Outbox outbox(*writing, keyless(), qos);
  Inbox inbox(*reading, keyless(), qos);
  REQUIRE(connected(outbox, inbox));
  constexpr std::uint32_t kCount = 5000;
  for (std::uint32_t i = 0; i < kCount; ++i) outbox.writer().write(make_number(i));
  REQUIRE(eventually([&] { return inbox.count() == kCount; }));
  const auto values = numbers(inbox.received());
  for (std::uint32_t i = 0; i < kCount; ++i) REQUIRE(values[i] == i);
  CHECK(outbox.writer().wait_for_acknowledgments(10s));
}

TEST_CASE_METHOD(Wire, "large reliable samples in a row all arrive") {
  Qos qos = keep_all();
  qos.max_blocking = 10s;
  Outbox outbox(*writing, keyless(), qos);
  Inbox inbox(*reading, keyless(), qos);
  REQUIRE(connected(outbox, inbox));
  for (std::uint32_t i = 0; i < 16; ++i) outbox.writer().write(make_sample(1u << 20, i));
  REQUIRE(eventually([&] { return inbox.count() == 16; }));
  const auto received = inbox.received();
  for (std::uint32_t i = 0; i < 16; ++i) CHECK((received[i].cdr == make_sample(1u << 20, i)));
}

TEST_CASE_METHOD(Connected, "samples of both byte orders are handed over as they are") {
  auto big_endian = make_number(1);
  big_endian[1] = std::byte{0};
  outbox.writer().write(big_endian);
  REQUIRE(eventually([&] { return inbox.count() == 1; }));
  CHECK((inbox.received()[0].cdr == big_endian));
}

TEST_CASE_METHOD(Wire, "best-effort samples that arrive are whole, and none comes twice") {
  Qos qos;
  qos.reliable = false;
  qos.history_depth = 1000;
  Outbox outbox(*writing, keyless(), qos);
  Inbox inbox(*reading, keyless(), qos);
  REQUIRE(matched(outbox, inbox));
  std::uint32_t next = 0;
  REQUIRE(eventually([&] {
    outbox.writer().write(make_number(next++));
    return inbox.count() >= 20;
  }));
  const auto values = numbers(inbox.received());
  for (std::size_t i = 1; i < values.size(); ++i) CHECK(values[i - 1] < values[i]);
}

TEST_CASE_METHOD(
    Wire,
    "a best-effort reader hears a reliable writer, but a reliable reader no best-effort one") {
  Qos best_effort;
  best_effort.reliable = false;
  Outbox reliable(*writing, keyless("reliable"), keep_all());
  Inbox modest(*reading, keyless("reliable"), best_effort);
  Outbox careless(*writing, keyless("careless"), best_effort);
  Inbox demanding(*reading, keyless("careless"), keep_all());
  REQUIRE(matched(reliable, modest));
  REQUIRE(eventually([&] {
    reliable.writer().write(make_number(7));
    return modest.count() > 0;
  }));
  // Discovery is in order: had these two been to match, they would have by now.
  Outbox later(*writing, keyless("later"), keep_all());
  Inbox late(*reading, keyless("later"), keep_all());
  REQUIRE(matched(later, late));
  CHECK(careless.writer().matched_readers().empty());
  CHECK(demanding.reader().matched_writers().empty());
}

TEST_CASE_METHOD(Wire, "a reader with a depth keeps the newest samples of each instance") {
  Qos qos = keep_all();
  qos.history_depth = 2;
  Outbox outbox(*writing, keyed(), keep_all());
  const auto reader = reading->create_reader(keyed(), qos);
  Inbox witness(*reading, keyed(), keep_all());
  REQUIRE(matched(outbox, witness));
  REQUIRE(eventually([&] { return !reader->matched_writers().empty(); }));
  REQUIRE(eventually([&] { return outbox.writer().matched_readers().size() == 2; }));
  for (std::uint32_t i = 0; i < 5; ++i) {
    outbox.writer().write(make_number(i), make_key(1));
    outbox.writer().write(make_number(100 + i), make_key(2));
  }
  REQUIRE(eventually([&] { return witness.count() == 10; }));
  REQUIRE(outbox.writer().wait_for_acknowledgments(10s));
  std::map<KeyHash, std::vector<std::uint32_t>> kept;
  reader->take([&](const Sample& sample) {
    kept[sample.key].push_back(to_number({sample.cdr.begin(), sample.cdr.end()}));
  });
  CHECK(kept[make_key(1)] == std::vector<std::uint32_t>{3, 4});
  CHECK(kept[make_key(2)] == std::vector<std::uint32_t>{103, 104});
}

TEST_CASE_METHOD(Wire, "take hands over at most as many samples as asked for, oldest first") {
  Outbox outbox(*writing, keyless(), keep_all());
  const auto reader = reading->create_reader(keyless(), keep_all());
  REQUIRE(eventually([&] { return !reader->matched_writers().empty(); }));
  REQUIRE(eventually([&] { return !outbox.writer().matched_readers().empty(); }));
  for (std::uint32_t i = 0; i < 5; ++i) outbox.writer().write(make_number(i));
  REQUIRE(outbox.writer().wait_for_acknowledgments(10s));
  std::vector<std::uint32_t> values;
  const auto keep = [&](const Sample& sample) {
    values.push_back(to_number({sample.cdr.begin(), sample.cdr.end()}));
  };
  REQUIRE(
      eventually([&] { return reader->take(keep, 2 - values.size()) > 0 && values.size() == 2; }));
  CHECK(values == std::vector<std::uint32_t>{0, 1});
  REQUIRE(eventually([&] {
    reader->take(keep);
    return values.size() == 5;
  }));
  CHECK(values == std::vector<std::uint32_t>{0, 1, 2, 3, 4});
  CHECK(reader->take(keep) == 0);
}

TEST_CASE_METHOD(Wire, "one writer serves several threads") {
  Qos qos = keep_all();
  qos.max_blocking = 5s;
  Outbox outbox(*writing, keyless(), qos);
  Inbox inbox(*reading, keyless(), qos);
  REQUIRE(connected(outbox, inbox));
  constexpr std::uint32_t kThreads = 4;
  constexpr std::uint32_t kEach = 250;
  std::vector<std::thread> threads;
  for (std::uint32_t thread = 0; thread < kThreads; ++thread) {
    threads.emplace_back([&, thread] {
      for (std::uint32_t i = 0; i < kEach; ++i) {
        outbox.writer().write(make_number(thread * 1000 + i));
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  REQUIRE(eventually([&] { return inbox.count() == kThreads * kEach; }));
  std::map<std::uint32_t, std::uint32_t> next;
  for (const std::uint32_t value : numbers(inbox.received())) {
    REQUIRE(value % 1000 == next[value / 1000]++);
  }
}

TEST_CASE_METHOD(Wire, "many writers of one topic reach one reader, each in its order") {
  Inbox inbox(*reading, keyless(), keep_all());
  std::vector<std::unique_ptr<Outbox>> writers;
  for (int i = 0; i < 20; ++i) {
    writers.push_back(std::make_unique<Outbox>(*writing, keyless(), keep_all()));
  }
  for (const auto& writer : writers) REQUIRE(matched(*writer, inbox));
  for (std::uint32_t round = 0; round < 10; ++round) {
    for (const auto& writer : writers) writer->writer().write(make_number(round));
  }
  REQUIRE(eventually([&] { return inbox.count() == 200; }));
  std::map<Guid, std::uint32_t> next;
  for (const Received& sample : inbox.received()) {
    CHECK(to_number(sample.cdr) == next[sample.writer]++);
  }
  CHECK(next.size() == writers.size());
}

TEST_CASE_METHOD(Wire,
                 "several readers, also of the writer's own participant, get the same bytes") {
  Outbox outbox(*writing, keyless(), keep_all());
  Inbox own(*writing, keyless(), keep_all());
  Inbox one(*reading, keyless(), keep_all());
  Inbox other(*reading, keyless(), keep_all());
  for (Inbox* inbox : {&own, &one, &other}) REQUIRE(connected(outbox, *inbox));
  for (Inbox* inbox : {&own, &one, &other}) {
    REQUIRE(outbox.writer().wait_for_acknowledgments(10s));
    inbox->forget_samples();
  }
  for (std::uint32_t size = 4; size < 12; ++size) outbox.writer().write(make_sample(size, size));
  for (Inbox* inbox : {&own, &one, &other}) {
    REQUIRE(eventually([&] { return inbox->count() == 8; }));
    const auto received = inbox->received();
    for (std::uint32_t size = 4; size < 12; ++size) {
      CHECK((received[size - 4].cdr == make_sample(size, size)));
    }
  }
}

TEST_CASE_METHOD(
    Wire, "a sample that is kept outlives the call, its reader's next samples and the reader") {
  Outbox outbox(*writing, keyless(), keep_all());
  std::mutex mutex;
  std::vector<std::pair<std::shared_ptr<const void>, std::span<const std::byte>>> kept;
  ReaderListener listener;
  listener.on_data = [&](Reader& reader) {
    reader.take([&](const Sample& sample) {
      std::lock_guard lock(mutex);
      kept.emplace_back(sample.keep(), sample.cdr);
    });
  };
  auto reader = reading->create_reader(keyless(), keep_all(), listener);
  REQUIRE(eventually([&] { return !outbox.writer().matched_readers().empty(); }));
  REQUIRE(eventually([&] { return !reader->matched_writers().empty(); }));
  for (std::uint32_t i = 0; i < 10; ++i) outbox.writer().write(make_sample(10'001, i));
  REQUIRE(eventually([&] {
    std::lock_guard lock(mutex);
    return kept.size() == 10;
  }));
  reader.reset();
  for (std::uint32_t i = 0; i < 10; ++i) {
    const auto& cdr = kept[i].second;
    CHECK((std::vector(cdr.begin(), cdr.end()) == make_sample(10'001, i)));
  }
}

TEST_CASE_METHOD(
    Wire, "a sample that no reader would take is refused where it is written, with the limit") {
  Outbox outbox(*writing, keyless(), keep_all());
  const std::size_t size = (std::size_t{256} << 20) + 1;
  const std::unique_ptr<std::byte, void (*)(void*)> memory(
      static_cast<std::byte*>(std::calloc(size, 1)), std::free);  // none of which is touched
  CHECK_THROWS_AS(outbox.writer().write({memory.get(), size}), InvalidArgument);
  CHECK_THROWS_WITH(outbox.writer().write({memory.get(), size}),
                    Catch::Contains("takes 268435457 bytes; readers take 268435456 (256 MiB) at "
                                    "most: send it in parts"));
}
