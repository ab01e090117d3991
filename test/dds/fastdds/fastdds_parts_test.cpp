// The parts of the Fast DDS back end that can be seen to work without a network.
#include <catch2/catch.hpp>
#include <future>

#include "core/threads/stall_watch.hpp"
#include "dds/fastdds/acknack_repair.hpp"
#include "dds/fastdds/announcement_pace.hpp"
#include "dds/fastdds/events.hpp"
#include "dds/fastdds/fast_lease_watch.hpp"
#include "dds/fastdds/fast_silence.hpp"
#include "dds/fastdds/forgetting.hpp"
#include "dds/fastdds/liveliness_assertions.hpp"
#include "dds/fastdds/put_off_leases.hpp"
#include "dds/fastdds/received_payloads.hpp"
#include "dds/fastdds/suspend_detector.hpp"
#include "test/tools/eventually.hpp"
#include "test/tools/log.hpp"
#include "test/tools/rtps_packet.hpp"

using namespace skein;
using namespace skein::dds::fastdds;
using skein::test::Octets;
using skein::test::OctetWriter;
using skein::test::RtpsPacket;
using namespace std::chrono_literals;

namespace {

Guid participant(std::uint8_t number) {
  Guid guid;
  guid.bytes[0] = number;
  return guid;
}

/// An RTPS message's header, with its sender.
std::vector<unsigned char> message_from(const Guid& sender) {
  std::vector<unsigned char> message{'R', 'T', 'P', 'S', 2, 3, 1, 15};
  message.insert(message.end(), sender.bytes.begin(), sender.bytes.begin() + 12);
  return message;
}

void append(std::vector<unsigned char>& message, std::initializer_list<unsigned char> bytes) {
  message.insert(message.end(), bytes);
}

/// An announcement whose lease has these seconds, least significant byte first.
std::vector<unsigned char> announcement(std::array<unsigned char, 4> seconds) {
  auto message = message_from(participant(1));
  append(message, {0x09, 1, 8, 0, 1, 2, 3, 4, 5, 6, 7, 8});     // INFO_TS
  append(message, {0x15, 1 | 2 | 4, 60, 0, 0, 0, 16, 0});       // DATA, little-endian
  append(message, {0, 1, 0, 0xc7, 0, 1, 0, 0xc2});              // from announcer
  append(message, {0, 0, 0, 0, 1, 0, 0, 0});                    // its number
  append(message, {0x71, 0, 4, 0, 0, 0, 0, 0, 0x01, 0, 0, 0});  // inline QoS
  append(message, {0, 3, 0, 0});                                // PL_CDR_LE
  append(message, {0x16, 0, 4, 0, 1, 15, 0, 0});                // the vendor
  append(message, {0x02, 0, 8, 0, seconds[0], seconds[1], seconds[2], seconds[3], 0, 0, 0, 0x80});
  append(message, {0x01, 0, 0, 0});
  return message;
}

constexpr std::size_t kSecondsAt = 20 + 12 + 24 + 12 + 4 + 8 + 4;

enum class Maker { Fast, Cyclone };

/// What a reader says to a writer: it has all below `base`, and asks for `missing` ones from there.
struct AckNack {
  std::int64_t base;
  std::uint32_t missing;
  std::uint32_t count;
  bool final = true;
};

Octets acknack(const AckNack& said, Maker maker = Maker::Fast) {
  OctetWriter body = test::entities(participant(2), participant(3));
  body.number(said.base).u32(said.missing);
  if (said.missing > 0) body.u32(~0u << (32 - said.missing));
  body.u32(said.count);
  Octets octets = RtpsPacket(participant(1)).submessage(0x06, said.final ? 0x02 : 0, body).octets();
  if (maker == Maker::Cyclone) octets[7] = 0x10;
  return octets;
}

/// What Fast DDS reads of it.
Octets repaired(AckNackRepair& repair, const AckNack& said, Maker maker = Maker::Fast,
                bool just_returned = false) {
  Octets octets = acknack(said, maker);
  repair.repair(octets.data(), octets.size(), just_returned);
  return octets;
}

/// The form in which a reader says that it has nothing, and wants to know what there is.
AckNack anew(std::uint32_t count) { return {0, 0, count, false}; }

/// That of `octets` `expected` is the beginning, and the rest padding.
bool begins_with(Octets octets, const Octets& expected) {
  if (octets.size() < expected.size() + 4) return octets == expected;
  const bool padded = octets[expected.size()] == 0x01 &&
                      octets[expected.size() + 2] == octets.size() - expected.size() - 4;
  octets.resize(expected.size());
  return padded && octets == expected;
}

constexpr AnnouncementPace::Destination to(std::uint32_t port) { return {nullptr, 1, port}; }

/// Of the writer that announces writers (3) or readers (4).
void append_data(std::vector<unsigned char>& message, unsigned char announcer,
                 unsigned char number) {
  append(message, {0x15, 1, 20, 0, 0, 0, 16, 0, 0, 0, 0, 0});
  append(message, {0, 0, announcer, 0xc2, 0, 0, 0, 0, number, 0, 0, 0});
}

void append_heartbeat(std::vector<unsigned char>& message, unsigned char announcer,
                      unsigned char last) {
  append(message, {0x07, 1, 28, 0, 0, 0, 0, 0, 0, 0, announcer, 0xc2});
  append(message, {0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, last, 0, 0, 0, 1, 0, 0, 0});
}

/// All before these numbers are acknowledged.
struct Acknowledged {
  std::uint32_t writers;
  std::uint32_t readers;
  bool operator==(const Acknowledged&) const = default;
};

Acknowledged acknowledged(const SentAnnouncements& sent) {
  const auto message = sent.acknowledged_by(participant(7));
  constexpr std::size_t kBase = 20 + 4 + 8 + 4;
  return {message[kBase], message[kBase + 28]};
}

void note(SentAnnouncements& sent, unsigned char* message, std::size_t size) {
  dds::rtps_message::for_each_submessage(message, size,
                                         [&](const auto& submessage) { sent.note(submessage); });
}

std::optional<std::int64_t> announced_in(unsigned char* message, std::size_t size) {
  std::optional<std::int64_t> number;
  dds::rtps_message::for_each_submessage(message, size, [&](const auto& submessage) {
    if (const auto announced = announcement_number(submessage)) number = announced;
  });
  return number;
}

std::vector<Guid> farewells_in(unsigned char* message, std::size_t size) {
  std::vector<Guid> all;
  for_each_farewell(message, size, [&](const Guid& each) { all.push_back(each); });
  return all;
}

}  // namespace

TEST_CASE("a reader that acknowledges less than before begins anew") {
  AckNackRepair repair;
  const Maker maker = GENERATE(Maker::Fast, Maker::Cyclone);
  const auto unchanged = [&](const AckNack& said) {
    return repaired(repair, said, maker) == acknack(said, maker);
  };
  CHECK(unchanged({1, 3, 1}));
  CHECK(unchanged({4, 0, 2}));
  CHECK(begins_with(repaired(repair, {1, 8, 3}, maker), acknack(anew(3), maker)));
  CHECK(unchanged({1, 8, 4}));
  CHECK(unchanged({9, 0, 5}));
  CHECK(begins_with(repaired(repair, {8, 0, 6}, maker), acknack(anew(6), maker)));
}

TEST_CASE("an old ACKNACK that comes late is no sign that its reader forgot") {
  AckNackRepair repair;
  CHECK(repaired(repair, {9, 0, 5}) == acknack({9, 0, 5}));
  CHECK(repaired(repair, {4, 0, 3}) == acknack({4, 0, 3}));
  CHECK(repaired(repair, {9, 1, 6}) == acknack({9, 1, 6}));
}

TEST_CASE("a reader that counts anew is understood though its first ACKNACK was lost") {
  AckNackRepair repair;
  const Maker maker = GENERATE(Maker::Fast, Maker::Cyclone);
  CHECK(repaired(repair, {9, 0, 57}, maker) == acknack({9, 0, 57}, maker));
  SECTION("it says that it has nothing") {
    CHECK(begins_with(repaired(repair, {1, 0, 2}, maker), acknack(anew(60), maker)));
  }
  SECTION("it asks for what a heartbeat told it of") {
    CHECK(begins_with(repaired(repair, {1, 8, 2}, maker), acknack(anew(60), maker)));
  }
  CHECK(repaired(repair, {1, 8, 3}, maker) == acknack({1, 8, 61}, maker));
  CHECK(repaired(repair, {9, 0, 4}, maker) == acknack({9, 0, 62}, maker));
}

TEST_CASE("Cyclone's first ACKNACK begins anew, and its counts go on where they were") {
  AckNackRepair repair;
  CHECK(repaired(repair, {1, 0, 0}, Maker::Cyclone) == acknack(anew(1), Maker::Cyclone));
  CHECK(repaired(repair, {5, 0, 1}, Maker::Cyclone) == acknack({5, 0, 2}, Maker::Cyclone));
  SECTION("it had forgotten, and tells so first") {
    CHECK(repaired(repair, {1, 0, 0}, Maker::Cyclone) == acknack(anew(3), Maker::Cyclone));
    CHECK(repaired(repair, {1, 4, 1}, Maker::Cyclone) == acknack({1, 4, 4}, Maker::Cyclone));
  }
  SECTION("it had forgotten, and a heartbeat came first") {
    CHECK(
        begins_with(repaired(repair, {1, 4, 0}, Maker::Cyclone), acknack(anew(3), Maker::Cyclone)));
  }
  SECTION("it has just returned, and acknowledges from memory") {
    CHECK(repaired(repair, {5, 0, 2}, Maker::Cyclone, true)[20] == 0x01);
  }
}

TEST_CASE("an announcement is told from farewells and from other messages") {
  auto plain = message_from(participant(1));
  append(plain, {0x09, 1, 8, 0, 1, 2, 3, 4, 5, 6, 7, 8});
  append(plain, {0x15, 1 | 4, 24, 0, 0, 0, 16, 0, 0, 1, 0, 0xc7, 0, 1, 0, 0xc2});
  append(plain, {0, 0, 0, 0, 7, 0, 0, 0, 0, 3, 0, 0});
  CHECK(announced_in(plain.data(), plain.size()) == 7);
  auto farewell = make_farewell(participant(7));
  CHECK_FALSE(announced_in(farewell.data(), farewell.size()));
  auto other = acknack({1, 0, 1});
  CHECK_FALSE(announced_in(other.data(), other.size()));
  for (std::size_t size = 0; size + 4 < plain.size(); ++size) {
    CHECK_FALSE(announced_in(plain.data(), size));
  }
}

TEST_CASE("who is discovered gets one announcement more, the others one a period") {
  AnnouncementPace pace(250ms);
  AnnouncementPace::Time now{1h};
  for (int i = 0; i < 6; ++i) CHECK(pace.due(1, to(7410), now += 1ms));
  for (int i = 0; i < 6; ++i) CHECK(pace.due(1, to(7412), now += 1ms));
  CHECK_FALSE(pace.due(1, to(7410), now += 1ms));
  CHECK_FALSE(pace.due(1, to(7412), now));

  pace.discovered(7412, now += 1ms);
  CHECK_FALSE(pace.due(1, to(7410), now += 1ms));
  CHECK(pace.due(1, to(7412), now));
  CHECK_FALSE(pace.due(1, to(7412), now += 1ms));

  CHECK(pace.due(1, to(7410), now += 250ms));
  CHECK(pace.due(1, to(7412), now));
  CHECK_FALSE(pace.due(1, to(7410), now += 1ms));
  CHECK(pace.due(2, to(7410), now));  // it says something else
}

TEST_CASE("an announced lease is put off by 34 years, and nothing else of the message changes") {
  const auto original = announcement({60, 0, 0, 0});
  auto message = original;
  put_off_leases(message.data(), message.size());
  CHECK(message[kSecondsAt + 3] == 0x40);
  message[kSecondsAt + 3] = 0;
  CHECK(message == original);
  CHECK(announced_lease(60 + (1 << 30), 500'000'000) == 60'500ms);
}

TEST_CASE("a lease without end, and one put off already, stay as they are") {
  for (const std::array<unsigned char, 4> seconds :
       {std::array<unsigned char, 4>{0xff, 0xff, 0xff, 0x7f}, {60, 0, 0, 0x40}}) {
    const auto original = announcement(seconds);
    auto message = original;
    put_off_leases(message.data(), message.size());
    CHECK(message == original);
  }
  CHECK_FALSE(announced_lease(0x7fffffff, 0xffffffff));
}

TEST_CASE("an announcement cut off anywhere is read no further than it goes") {
  const auto original = announcement({60, 0, 0, 0});
  for (std::size_t size = 20; size < original.size(); ++size) {
    const std::unique_ptr<unsigned char[]> exact(new unsigned char[size]);
    std::copy_n(original.begin(), size, exact.get());
    put_off_leases(exact.get(), size);
  }
}

TEST_CASE("a farewell is a disposal of the participant's announcement, and no announcement") {
  auto farewell = make_farewell(participant(7));
  CHECK(farewell[8] == 7);
  CHECK(farewell[22] + (farewell[23] << 8) == static_cast<int>(farewell.size()) - 24);
  const auto original = farewell;
  put_off_leases(farewell.data(), farewell.size());
  CHECK(farewell == original);
}

TEST_CASE("who leaves acknowledges first what was ever announced of endpoints, and nothing else") {
  SentAnnouncements sent;
  CHECK(acknowledged(sent) == Acknowledged{1, 1});
  auto message = message_from(participant(1));
  append_data(message, 3, 5);
  append_data(message, 0x12, 99);  // a user's writer
  append_heartbeat(message, 4, 8);
  note(sent, message.data(), message.size());
  CHECK(acknowledged(sent) == Acknowledged{6, 9});

  auto repeated = message_from(participant(1));
  append_data(repeated, 3, 2);
  append_heartbeat(repeated, 4, 7);
  note(sent, repeated.data(), repeated.size());
  CHECK(acknowledged(sent) == Acknowledged{6, 9});
}

TEST_CASE("the acknowledgment of who leaves has the form that the specification asks for") {
  const auto message = SentAnnouncements().acknowledged_by(participant(7));
  auto expected = message_from(participant(7));
  for (const unsigned char announcer : {3, 4}) {
    append(expected, {0x06, 1 | 2, 24, 0});  // ACKNACK, little-endian, final
    append(expected, {0, 0, announcer, 0xc7, 0, 0, announcer, 0xc2});
    append(expected, {0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0xff, 0xff, 0xff, 0xff});
  }
  CHECK(std::ranges::equal(message, expected));
}

TEST_CASE("a farewell is known by its status, and says who leaves") {
  auto farewell = make_farewell(participant(7));
  CHECK(farewells_in(farewell.data(), farewell.size()) == std::vector{participant(7)});
  auto present = announcement({60, 0, 0, 0});
  CHECK(farewells_in(present.data(), present.size()).empty());

  auto of_another = make_farewell(participant(7));
  of_another[20 + 24 + 4] = 8;  // the key
  CHECK(farewells_in(of_another.data(), of_another.size()) == std::vector{participant(8)});
  auto without_key = make_farewell(participant(7));
  without_key[20 + 24] = 0;  // padding
  CHECK(farewells_in(without_key.data(), without_key.size()) == std::vector{participant(7)});
}

TEST_CASE("farewells and announcements cut off anywhere are read no further than they go") {
  const auto farewell = make_farewell(participant(7));
  auto announced = message_from(participant(1));
  append_data(announced, 3, 5);
  append_heartbeat(announced, 4, 8);
  SentAnnouncements sent;
  for (const std::span<const unsigned char> whole :
       {std::span<const unsigned char>(farewell), std::span<const unsigned char>(announced)}) {
    for (std::size_t size = 20; size < whole.size(); ++size) {
      const std::unique_ptr<unsigned char[]> exact(new unsigned char[size]);
      std::copy_n(whole.begin(), size, exact.get());
      CHECK(farewells_in(exact.get(), size).empty());
      note(sent, exact.get(), size);
    }
  }
}

TEST_CASE("a participant that is not heard of for its lease is overdue, once") {
  FastLeaseWatch signs;
  FastLeaseWatch::Time now{1h};
  signs.watch(now, 10ms);
  signs.follow(participant(1), 60ms, now);
  signs.follow(participant(2), 60ms, now);
  signs.follow(participant(3), std::nullopt, now);
  for (int i = 0; i < 5; ++i) CHECK(signs.watch(now += 10ms, 10ms).empty());
  signs.heard(participant(2), now);
  CHECK(signs.watch(now += 10ms, 10ms).empty());
  CHECK(signs.watch(now += 10ms, 10ms) == std::vector{participant(1)});
  CHECK(signs.watch(now += 10ms, 10ms).empty());
  for (int i = 0; i < 3; ++i) CHECK(signs.watch(now += 10ms, 10ms).empty());
  CHECK(signs.watch(now += 10ms, 10ms) == std::vector{participant(2)});
  CHECK(signs.drop_all() == std::vector{participant(3)});
}

TEST_CASE("while this process did not run, nobody's lease runs out") {
  FastLeaseWatch signs;
  FastLeaseWatch::Time now{1h};
  signs.watch(now, 10ms);
  signs.follow(participant(1), 60ms, now);
  CHECK(signs.watch(now += 1h, 10ms).empty());
  CHECK(signs.watch(now += 10ms, 10ms).empty());
  CHECK(signs.alive(participant(1), 60ms, now));
  for (int i = 0; i < 3; ++i) CHECK(signs.watch(now += 10ms, 10ms).empty());
  CHECK(signs.watch(now += 20ms, 10ms).size() == 1);
}

TEST_CASE(
    "a reader hears once of silence and once of return; a stop of its own process is neither") {
  int silent = 0;
  int returned = 0;
  EventThread events([] {});
  const auto all_told = [&] {
    std::promise<void> last;
    events.post([&] { last.set_value(); });
    last.get_future().wait();
  };
  StartupTransportDescriptor::State transport(1s, 250ms, {});
  FastSilence silence(transport, events);
  const auto reader = std::make_shared<EndpointEvents>(
      events,
      EndpointListener{{}, [&](const Guid&, bool alive) { ++(alive ? returned : silent); }, {}});
  reader->matched(participant(1), true);
  FastSilence::Time now{1h};
  silence.watch_liveliness(reader, 100ms);
  silence.follow(participant(1), 10s, now);
  silence.check(now);
  for (int i = 0; i < 10; ++i) silence.check(now += 5ms);
  silence.check(now += 1h);  // counts as 10 ms
  for (int i = 0; i < 8; ++i) silence.check(now += 5ms);
  all_told();
  CHECK(silent == 0);
  silence.check(now += 5ms);
  silence.check(now += 1h);
  for (int i = 0; i < 8; ++i) silence.check(now += 5ms);
  all_told();
  CHECK(silent == 1);
  CHECK(returned == 0);
  transport.lease_watch.heard(participant(1), now);
  silence.check(now += 5ms);
  all_told();
  CHECK(silent == 1);
  CHECK(returned == 1);
}

TEST_CASE("what passes while an endpoint is removed is no silence of other participants") {
  EventThread events([] {});
  StartupTransportDescriptor::State transport(1s, 250ms, {});
  FastSilence silence(transport, events);
  FastSilence::Time now{1h};
  silence.follow(participant(1), 100ms, now);
  silence.check(now);
  {
    const std::scoped_lock removing(transport.discovery.removal());
    for (int i = 0; i < 40; ++i) silence.check(now += 5ms);
  }
  silence.check(now += 5ms);  // the removal counts as 10 ms
  for (int i = 0; i < 17; ++i) silence.check(now += 5ms);
  SECTION("its lease is not over") {
    CHECK(transport.lease_watch.drop_all() == std::vector{participant(1)});
  }
  SECTION("then it is") {
    for (int i = 0; i < 2; ++i) silence.check(now += 5ms);
    CHECK(transport.lease_watch.drop_all().empty());
  }
}

TEST_CASE(
    "liveliness is asserted five times in two of the shortest lease, and never after the end") {
  int asserted = 0;
  LivelinessAssertions assertions([&] { ++asserted; });
  Instant now{1h};
  assertions.assert_if_due(now);
  CHECK(asserted == 0);
  CHECK(assertions.begin(1s) == 100ms);
  for (int i = 0; i < 20; ++i) assertions.assert_if_due(now += 100ms);
  CHECK(asserted == 5);
  CHECK(assertions.begin(100ms) == 10ms);
  CHECK(assertions.begin(10s) == 1s);
  for (int i = 0; i < 20; ++i) assertions.assert_if_due(now += 10ms);
  CHECK(asserted == 10);
  assertions.end();
  assertions.assert_if_due(now += 1h);
  CHECK(asserted == 10);
}

TEST_CASE(
    "a participant that sent nothing for its lease is mute until it is woken; a busy one not") {
  SuspendDetector watch(100ms);
  int wakes = 0;
  watch.on_wake = [&] { ++wakes; };
  SuspendDetector::Time now{1h};
  CHECK(watch.may_receive(now));
  CHECK(watch.may_send(now));
  // Busy: each announcement is late, by far more than half the lease.
  for (int i = 0; i < 10; ++i) {
    CHECK(watch.may_receive(now += 99ms));
    CHECK(watch.may_send(now));
  }
  CHECK(wakes == 0);
  SECTION("it receives first") { CHECK_FALSE(watch.may_receive(now += 101ms)); }
  SECTION("it sends first") { CHECK_FALSE(watch.may_send(now += 101ms)); }
  CHECK(wakes == 1);
  CHECK_FALSE(watch.may_send(now += 1h));
  CHECK_FALSE(watch.may_receive(now));
  CHECK(wakes == 1);
  watch.awake(now);
  CHECK(watch.may_receive(now));
  CHECK(watch.may_send(now));
  CHECK(wakes == 1);
}

TEST_CASE("a payload has room for Fast DDS's list of fragments, whatever their size") {
  for (const std::uint32_t size : {1u, 2u, 3u, 5u, 9u, 63u, 65u, 1001u}) {
    for (std::uint16_t fragment = 1; fragment <= std::min(size, 64u); ++fragment) {
      ReceivedPayloads payloads;
      rtps::CacheChange_t change;
      payloads.reserve(size, change);
      change.serializedPayload.length = size;
      // Fast DDS itself writes an entry for each, at its fragment's place rounded up to 4.
      const std::uint32_t count = (size + fragment - 1) / fragment;
      const std::size_t end = (std::size_t{fragment} * (count - 1) + 3) / 4 * 4 + 4;
      INFO("size " << size << ", fragments of " << fragment);
      change.setFragmentSize(fragment, true);  // under valgrind or ASan: writes nowhere else
      CHECK(payloads.take(change).capacity() >= end);
      payloads.release(change.serializedPayload);
    }
  }
}

TEST_CASE("an event that does not end is told of, with the thread's name") {
  const test::Log log;
  std::atomic<bool> inside{false};
  std::atomic<bool> may_end{false};
  EventThread thread([] {});
  thread.post([&] {
    inside = true;
    test::eventually([&] { return may_end.load(); });
  });
  REQUIRE(test::eventually([&] { return inside.load(); }));
  Instant now = std::chrono::steady_clock::now();
  for (int i = 0; i < 4; ++i) {
    StallWatch::of_this_process().look(now += StallWatch::kPeriod);
  }
  CHECK(log.count("'skein-dds-event' has been in one piece of work") == 1);
  may_end = true;
}

TEST_CASE("events are told although each tick takes longer than the time to the next one") {
  std::atomic<int> ticks{0};
  std::atomic<int> told{0};
  EventThread thread([&] {
    const int before = ticks++;
    test::eventually([&] { return told > before; }, 10ms);
  });
  thread.tick_every(1ms);
  REQUIRE(test::eventually([&] { return ticks > 0; }));
  for (int i = 0; i < 10; ++i) thread.post([&] { ++told; });
  CHECK(test::eventually([&] { return told == 10; }));
}
