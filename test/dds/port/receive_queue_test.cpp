#include "dds/port/receive_queue.hpp"

#include <catch2/catch.hpp>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "skein/clock.hpp"
#include "test/tools/log.hpp"

using namespace skein;
using namespace skein::dds;
using namespace std::chrono_literals;

namespace {

using SharedBytes = std::shared_ptr<const std::vector<std::byte>>;

struct Holder {
  SharedBytes bytes;
  std::shared_ptr<const void> keep() { return std::move(bytes); }
};

Payload payload(SharedBytes bytes) {
  const std::span<const std::byte> cdr(*bytes);
  return {cdr, Holder{std::move(bytes)}};
}

SharedBytes bytes_of(std::vector<std::uint8_t> values) {
  auto bytes = std::make_shared<std::vector<std::byte>>();
  for (const std::uint8_t value : values) bytes->push_back(std::byte{value});
  return bytes;
}

/// PLAIN_CDR whose body is one number.
SharedBytes number(std::uint8_t value) { return bytes_of({0, 1, 0, 0, value}); }

Guid guid(std::uint8_t value) {
  Guid result;
  result.bytes[15] = value;
  return result;
}

/// A queue whose time stands still.
struct Stage {
  explicit Stage(const Qos& qos = {}, ReceiveQueue::FindKey find_key = {})
      : queue(
            "pose", qos, std::move(find_key), [this](const KeyHash& key) { missed.push_back(key); },
            clock) {}

  SourceTime now() const { return clock.now().time_since_epoch(); }

  bool store(std::uint8_t value, const KeyHash& key = {}, const Guid& writer = guid(1),
             const WriterOffer& offer = {}) {
    return queue.store({payload(number(value)), InstanceState::Alive, key, writer, now()}, offer);
  }

  bool dispose(const KeyHash& key, const Guid& writer = guid(1)) {
    return queue.store({Payload{}, InstanceState::Disposed, key, writer, now()}, WriterOffer{});
  }

  /// The numbers taken; -1 for a disposal.
  std::vector<int> take(std::size_t limit = SIZE_MAX) {
    std::vector<int> values;
    queue.take(
        [&](const Sample& sample) {
          const bool alive = sample.state == InstanceState::Alive;
          values.push_back(alive ? std::to_integer<int>(sample.cdr[4]) : -1);
        },
        limit);
    return values;
  }

  ManualClock clock;
  std::vector<KeyHash> missed;
  ReceiveQueue queue;
};

}  // namespace

TEST_CASE_METHOD(Stage, "samples are taken oldest first, no more than are asked for, and once") {
  CHECK(queue.empty());
  CHECK(store(1, guid(1)));
  CHECK(store(2, guid(2)));
  CHECK(dispose(guid(1)));
  CHECK(take(2) == std::vector{1, 2});
  CHECK_FALSE(queue.empty());
  CHECK(take() == std::vector{-1});
  CHECK(queue.empty());
}

TEST_CASE_METHOD(Stage, "what is no PLAIN_CDR, or has no key, is dropped and counted") {
  const auto comes = [&](SharedBytes bytes, std::optional<KeyHash> key) {
    return queue.store({payload(std::move(bytes)), InstanceState::Alive, key, guid(1), now()},
                       WriterOffer{});
  };
  CHECK_FALSE(comes(bytes_of({}), KeyHash{}));
  CHECK_FALSE(comes(bytes_of({0, 1, 0}), KeyHash{}));
  CHECK_FALSE(comes(bytes_of({0, 7, 0, 0, 1}), KeyHash{}));
  CHECK_FALSE(comes(number(1), std::nullopt));
  CHECK(queue.counters().malformed == 4);
  CHECK(comes(number(2), KeyHash{}));
  CHECK(take() == std::vector{2});
}

TEST_CASE("a key that did not come beside the sample is found in it, in a disposal's bytes too") {
  Stage stage({}, [](std::span<const std::byte> cdr) -> std::optional<KeyHash> {
    if (cdr[4] == std::byte{0}) return std::nullopt;
    return guid(std::to_integer<std::uint8_t>(cdr[4]));
  });
  const auto comes = [&](Payload bytes, InstanceState state) {
    return stage.queue.store({std::move(bytes), state, std::nullopt, guid(1), std::nullopt});
  };
  CHECK(comes(payload(number(5)), InstanceState::Alive));
  CHECK(comes(payload(number(6)), InstanceState::Disposed));
  CHECK_FALSE(comes(payload(number(0)), InstanceState::Alive));
  CHECK_FALSE(comes(Payload{}, InstanceState::Disposed));
  CHECK(stage.queue.counters().malformed == 2);
  std::vector<std::pair<KeyHash, std::size_t>> taken;
  const auto consumer = [&](const Sample& sample) {
    taken.emplace_back(sample.key, sample.cdr.size());
  };
  CHECK(stage.queue.take(consumer, SIZE_MAX) == 2);
  REQUIRE(taken.size() == 2);
  CHECK((taken[0].first == guid(5) && taken[0].second == 5));
  CHECK((taken[1].first == guid(6) && taken[1].second == 0));
}

TEST_CASE("the oldest of an instance, or of all, gives way to what is beyond the limits") {
  Qos qos;
  SECTION("history depth") {
    qos.history_depth = 2;
    Stage stage(qos);
    CHECK(stage.store(1, guid(1)));
    for (std::uint8_t value = 2; value <= 5; ++value) CHECK(stage.store(value, guid(2)));
    CHECK(stage.queue.counters().replaced == 2);
    CHECK(stage.take() == std::vector{1, 4, 5});
  }
  SECTION("samples that wait") {
    qos.max_waiting = 2;
    Stage stage(qos);
    CHECK(stage.store(1, guid(1)));
    for (std::uint8_t value = 2; value <= 5; ++value) CHECK(stage.store(value, guid(2)));
    CHECK(stage.queue.counters().replaced == 3);
    CHECK(stage.take() == std::vector{4, 5});
  }
}

TEST_CASE_METHOD(Stage, "a sample expires to the instant, on its way and while it waits") {
  const WriterOffer offer{0, 100ms};
  const auto comes = [&](std::uint8_t value, std::optional<SourceTime> written) {
    return queue.store({payload(number(value)), InstanceState::Alive, KeyHash{}, guid(1), written},
                       offer);
  };
  CHECK_FALSE(comes(1, now() - 100ms));
  CHECK(comes(2, now() - 99ms));
  CHECK(take() == std::vector{2});
  CHECK(comes(3, now() - 1ms));
  CHECK(comes(4, std::nullopt));  // counted from when it came
  clock.advance(99ms);
  CHECK(take() == std::vector{4});
  CHECK(comes(5, std::nullopt));
  clock.advance(100ms);
  CHECK(take().empty());
  CHECK(queue.counters().expired == 3);
}

TEST_CASE_METHOD(
    Stage, "a writer of whom all has expired when it comes is told of once, with the difference") {
  test::Log log;
  const WriterOffer offer{0, 500ms};
  const auto comes = [&](std::uint8_t writer, SourceTime written) {
    return queue.store({payload(number(1)), InstanceState::Alive, KeyHash{}, guid(writer), written},
                       offer);
  };
  // Late now and then, and another one in time.
  for (int i = 0; i < 9; ++i) CHECK_FALSE(comes(1, now() - 3600s));
  CHECK(comes(1, now()));
  for (int i = 0; i < 9; ++i) {
    CHECK_FALSE(comes(1, now() - 3600s));
    CHECK(comes(2, now()));
  }
  CHECK(log.text() == "");
  for (int i = 0; i < 20; ++i) CHECK_FALSE(comes(1, now() - 3600s));
  CHECK(log.count("topic 'pose'") == 1);
  CHECK(log.count("is 3600000 ms old") == 1);
  CHECK(log.count("lifespan is 500 ms") == 1);
}

TEST_CASE_METHOD(Stage, "samples that do not say when they were written expire by when they came") {
  test::Log log;
  for (int i = 0; i < 20; ++i) {
    CHECK_FALSE(
        queue.store({payload(number(1)), InstanceState::Alive, KeyHash{}, guid(1), std::nullopt},
                    WriterOffer{0, 0ms}));
  }
  CHECK(log.count("is 0 ms old") == 1);
}

TEST_CASE("an instance is its strongest writer's, of equals the one with the lesser GUID") {
  Qos qos;
  qos.exclusive = true;
  Stage stage(qos);
  CHECK(stage.store(1, guid(7), guid(3), {1}));
  CHECK(stage.store(2, guid(7), guid(2), {1}));
  CHECK_FALSE(stage.store(3, guid(7), guid(3), {1}));
  CHECK(stage.store(4, guid(7), guid(4), {2}));
  CHECK_FALSE(stage.store(5, guid(7), guid(2), {1}));
  CHECK(stage.store(6, guid(8), guid(2), {1}));
  CHECK(stage.take() == std::vector{1, 2, 4, 6});
  CHECK(stage.queue.counters().replaced == 0);
}

TEST_CASE_METHOD(Stage, "an instance without exclusive ownership is everybody's") {
  CHECK(store(1, guid(7), guid(1), {2}));
  CHECK(store(2, guid(7), guid(2), {1}));
}

TEST_CASE("an instance passes on until its owner writes again") {
  Qos qos;
  qos.exclusive = true;
  qos.deadline = 100ms;
  Stage stage(qos);
  REQUIRE(stage.store(1, guid(7), guid(1), {2}));
  REQUIRE_FALSE(stage.store(2, guid(7), guid(2), {1}));
  SECTION("when the owner is unmatched") { stage.queue.writer_unmatched(guid(1)); }
  SECTION("when the owner is silent for its lease") { stage.queue.writer_not_alive(guid(1)); }
  SECTION("when the owner lets go of it") { stage.queue.instance_unregistered(guid(7), guid(1)); }
  SECTION("when the owner misses the deadline") { stage.clock.advance(100ms); }
  CHECK(stage.store(3, guid(7), guid(2), {1}));
  CHECK(stage.store(4, guid(7), guid(1), {2}));
}

TEST_CASE("others that go or let go do not touch the owner") {
  Qos qos;
  qos.exclusive = true;
  Stage stage(qos);
  REQUIRE(stage.store(1, guid(7), guid(1), {2}));
  stage.queue.instance_unregistered(guid(8), guid(1));
  stage.queue.instance_unregistered(guid(7), guid(2));
  stage.queue.writer_not_alive(guid(2));
  stage.queue.writer_unmatched(guid(3));
  CHECK_FALSE(stage.store(2, guid(7), guid(2), {1}));
}

TEST_CASE("a writer's samples are judged by what it offered when it was matched") {
  Qos qos;
  qos.exclusive = true;
  Stage stage(qos);
  const auto comes = [&](std::uint8_t value, const Guid& writer) {
    return stage.queue.store(
        {payload(number(value)), InstanceState::Alive, KeyHash{}, writer, stage.now()});
  };
  stage.queue.writer_matched(guid(1), {1});
  stage.queue.writer_matched(guid(2), {2, 100ms});
  CHECK(comes(1, guid(1)));
  CHECK(comes(2, guid(2)));
  CHECK_FALSE(comes(3, guid(1)));
  CHECK(comes(4, guid(3)));  // nothing is known of it
  stage.queue.writer_unmatched(guid(2));
  CHECK(comes(5, guid(1)));
  stage.clock.advance(100ms);
  CHECK(stage.take() == std::vector{1, 4, 5});
  CHECK(stage.queue.counters().expired == 1);
}

TEST_CASE("a deadline is watched from an instance's first sample until its disposal") {
  Qos qos;
  qos.deadline = 100ms;
  Stage stage(qos);
  stage.clock.advance(1s);
  CHECK(stage.missed.empty());
  stage.store(1, guid(1));
  stage.store(2, guid(2));
  stage.clock.advance(60ms);
  stage.store(3, guid(1));
  stage.dispose(guid(2));
  stage.clock.advance(99ms);
  CHECK(stage.missed.empty());
  stage.clock.advance(1ms);
  CHECK(stage.missed == std::vector{guid(1)});
  stage.clock.advance(200ms);
  CHECK(stage.missed == std::vector{guid(1), guid(1), guid(1)});
}

TEST_CASE("the bytes of a sample are kept on demand beyond the queue, else let go at once") {
  const auto kept = number(1);
  const auto taken = number(2);
  const auto replaced = number(3);
  const auto refused = number(4);
  const auto left = number(5);
  std::shared_ptr<const void> keeper;
  std::span<const std::byte> cdr;
  {
    Qos qos;
    qos.history_depth = 1;
    qos.exclusive = true;
    Stage stage(qos);
    const auto comes = [&](const SharedBytes& bytes, const KeyHash& key, const Guid& writer) {
      return stage.queue.store({payload(bytes), InstanceState::Alive, key, writer, stage.now()},
                               WriterOffer{});
    };
    CHECK(comes(kept, guid(1), guid(1)));
    CHECK(comes(taken, guid(2), guid(1)));
    CHECK(comes(replaced, guid(3), guid(1)));
    CHECK(comes(left, guid(3), guid(1)));
    CHECK_FALSE(comes(refused, guid(3), guid(2)));
    CHECK(replaced.use_count() == 1);
    CHECK(refused.use_count() == 1);
    const auto keep = [&](const Sample& sample) {
      keeper = sample.keep();
      cdr = sample.cdr;
    };
    CHECK(stage.queue.take(keep, 1) == 1);
    CHECK(stage.take(1) == std::vector{2});
    CHECK(taken.use_count() == 1);
    CHECK(left.use_count() == 2);
  }
  CHECK(left.use_count() == 1);
  CHECK(kept.use_count() == 2);
  CHECK((cdr.data() == kept->data() && cdr.size() == kept->size()));
  keeper.reset();
  CHECK(kept.use_count() == 1);
}
