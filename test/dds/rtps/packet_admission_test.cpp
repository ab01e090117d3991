// What the guard hands on by what was received of its sender before.
#include <catch2/catch.hpp>

#include "guard_stage.hpp"
#include "test/tools/invented_peer.hpp"

using namespace skein;
using namespace skein::test;
using namespace skein::test::guard_stage;
using dds::Admission;
using dds::Refusal;
using dds::RtpsGuard;
using dds::SkippedNumbers;
using namespace std::chrono_literals;

TEST_CASE_METHOD(Stage, "a heartbeat that leaps by 2^52 is refused, of a writer known or unknown") {
  const auto leap = [](const Guid& writer) {
    const std::int64_t far = std::int64_t{1} << 52;
    return from(writer, kHeartbeat, 0, heartbeat(writer, far, far));
  };
  CHECK(refuses(leap(writer_of(2)), Refusal::Leap));
  CHECK(passes(from(kWriter, kHeartbeat, 0, heartbeat(kWriter, 1, 5))));
  CHECK(refuses(leap(kWriter), Refusal::Leap));
  CHECK(passes(from(kWriter, kHeartbeat, 0, heartbeat(kWriter, 1, 6))));
}

TEST_CASE_METHOD(Stage, "a late joiner hears of a writer that has written a billion samples") {
  const std::int64_t billion = 1'000'000'000;
  CHECK(passes(from(kWriter, kHeartbeat, 0, heartbeat(kWriter, billion, billion))));
  CHECK(passes(from(kWriter, kData, kHasPayload, data(kWriter, billion + 1, kPayload))));
}

TEST_CASE_METHOD(Stage, "who was cut off may have missed a million samples a second") {
  CHECK(passes(from(kWriter, kHeartbeat, 0, heartbeat(kWriter, 1, 5))));
  const std::int64_t missed = 60'000'000;
  const auto beat = from(kWriter, kHeartbeat, 0, heartbeat(kWriter, missed, missed));
  CHECK(refuses(beat, Refusal::Leap));
  now += 60s;
  CHECK(passes(beat));
  CHECK(refuses(from(kWriter, kHeartbeat, 0, heartbeat(kWriter, 1, 2 * missed)), Refusal::Leap));
}

TEST_CASE_METHOD(
    Stage, "a gap is within what was announced, and no longer than a reader can count through") {
  const std::int64_t last = 900'000;
  REQUIRE(passes(from(kWriter, kHeartbeat, 0, heartbeat(kWriter, 1, last))));
  CHECK(passes(from(kWriter, kGap, 0, gap(kWriter, 3, 4000))));
  CHECK(refuses(from(kWriter, kGap, 0, gap(kWriter, 1'000'000, std::int64_t{1} << 40)),
                Refusal::Leap));
  CHECK(refuses(from(kWriter, kGap, 0, gap(kWriter, 0, 5)), Refusal::Form));
  CHECK(refuses(from(kWriter, kGap, 0, gap(kWriter, 5, 4)), Refusal::Form));
  // The reader asks again for the rest.
  CHECK(pass(from(kWriter, kGap, 0, gap(kWriter, 2, last)).octets()) ==
        from(kWriter, kGap, 0, gap(kWriter, 2, 2 + 65536)).octets());
}

TEST_CASE_METHOD(Stage, "all fragments of a sample agree on its size and theirs") {
  const auto fragment = [&](const FragmentClaim& claim) {
    return from(kWriter, kDataFrag, 0, data_frag(kWriter, 7, claim, 4096));
  };
  CHECK(passes(fragment({1, 1, 1024, 60'000})));
  CHECK(refuses(fragment({2, 1, 1024, 6'000}), Refusal::Fragment));
  CHECK(refuses(fragment({2, 1, 2048, 60'000}), Refusal::Fragment));
  CHECK(passes(fragment({2, 1, 1024, 60'000})));
}

TEST_CASE_METHOD(Stage, "only who is matched may begin a sample in fragments") {
  const Guid other = writer_of(2);
  CHECK(refuses(begins(other, 1, 100'000), Refusal::Unmatched));
  match(other);
  CHECK(passes(begins(other, 1, 100'000)));
  match(other, false);
  CHECK(refuses(begins(other, 1, 100'000), Refusal::Unmatched));
  guard.reader_gone(dds::rtps_message::entity_of(kReader));
  CHECK(refuses(begins(kWriter, 1, 100'000), Refusal::Unmatched));
}

TEST_CASE_METHOD(
    Stage, "what may be begun depends on what was received: a claim of 256 MiB is no reason") {
  constexpr std::uint32_t kLargest = Admission::kLargestSample;
  CHECK(refuses(begins(kWriter, 1, kLargest + 1), Refusal::Room));
  CHECK(refuses(begins(kWriter, 1, kLargest), Refusal::Room));
  // Who really sends so much is refused a part of it, which the reader asks for again.
  const std::uint32_t fragments = (kLargest + 59'999) / 60'000;
  std::uint32_t refused = 0;
  for (std::uint32_t i = 1; i < fragments; ++i) {
    refused += !passes(
        from(kWriter, kDataFrag, 0, data_frag(kWriter, 1, {i, 1, 60'000, kLargest}, 60'000)));
  }
  CHECK(refused > 0);
  CHECK(refused * Admission::kAhead <= fragments);
}

TEST_CASE_METHOD(
    Stage, "small claims of one participant leave others their room, from the same address too") {
  const Guid rogue = stranger_of(1);
  pass(announcement_of(rogue).octets(), kHere);
  match(rogue);
  for (int i = 1; i <= 20'000; ++i) {
    const FragmentClaim claim{1, 1, 256, 20'000'000};
    pass(from(rogue, kDataFrag, 0, data_frag(rogue, i, claim, 256)).octets(), kHere);
  }
  // What kWriter begins it has to earn now.
  std::uint32_t refused = 0;
  for (std::uint32_t i = 1; i <= 17; ++i) {
    refused += !passes(
        from(kWriter, kDataFrag, 0,
             data_frag(kWriter, 1, {i, 1, 60'000, 1'000'000}, 40'000 + (i < 17 ? 20'000 : 0))));
  }
  CHECK(refused <= 2);
}

TEST_CASE("a sample of which nothing comes any more is given up, and may begin anew") {
  Stage stage(SkippedNumbers::Counted);
  REQUIRE(stage.passes(stage.begins(kWriter, 1, 60'001)));
  stage.now += 4s;
  CHECK(stage.guard.give_up(stage.now).empty());
  REQUIRE(stage.passes(stage.begins(kWriter, 1, 60'001)));
  stage.now += 4s;
  CHECK(stage.guard.give_up(stage.now).empty());
  stage.now += 2s;
  const auto given_up = stage.guard.give_up(stage.now);
  REQUIRE(given_up.size() == 1);
  CHECK(given_up[0].participant == kWriter.participant());
  CHECK(given_up[0].writer == dds::rtps_message::entity_of(kWriter));
  CHECK(given_up[0].number == 1);
  // Not while the vendor may hold a part of it.
  CHECK(stage.refuses(stage.begins(kWriter, 1, 60'001), Refusal::Room));
  stage.guard.dropped(given_up[0]);
  CHECK(stage.guard.give_up(stage.now).empty());
  CHECK(stage.passes(stage.begins(kWriter, 1, 70'000)));
}

TEST_CASE("a participant that loses the rest of each sample may begin others") {
  Stage stage;  // Cyclone drops the oldest by itself
  for (int i = 1; i <= 20'000; ++i) {
    REQUIRE(stage.passes(stage.begins(kWriter, i, 100'000)));
    stage.now += 33ms;
  }
}

TEST_CASE_METHOD(Stage, "samples that are complete claim nothing") {
  for (int i = 1; i <= 20'000; ++i) {
    REQUIRE(
        passes(from(kWriter, kDataFrag, 0, data_frag(kWriter, i, {1, 1, 60'000, 60'000}, 60'000))));
  }
}

TEST_CASE_METHOD(Stage, "who has not announced itself is not heard") {
  const Guid stranger = stranger_of(1);
  const auto acknack = entities({}, stranger).number(1).u32(0).u32(7);
  const auto heard = [&](bool (Stage::*judged)(const RtpsPacket&)) {
    return (this->*judged)(from(stranger, kHeartbeat, 0, heartbeat(stranger, 1, 5))) &&
           (this->*judged)(from(stranger, kData, kHasPayload, data(stranger, 1, kPayload))) &&
           (this->*judged)(from(stranger, kGap, 0, gap(stranger, 1, 3))) &&
           (this->*judged)(from(stranger, 0x06, 0, acknack));
  };
  CHECK(heard(&Stage::refuses_stranger));
  CHECK(passes(announcement_of(stranger)));
  CHECK(heard(&Stage::passes));
  guard.removed(stranger.participant());
  CHECK(heard(&Stage::refuses_stranger));
  guard.found(stranger.participant());
  CHECK(heard(&Stage::passes));
}

TEST_CASE_METHOD(
    Stage, "a flood of strangers takes no memory, and none of those that are there forgotten") {
  CHECK(passes(from(kWriter, kHeartbeat, 0, heartbeat(kWriter, 1, 5))));
  guard.found(kWriter.participant());
  for (unsigned i = 0; i < 100'000; ++i) {
    const Guid stranger = stranger_of(i);
    REQUIRE(refuses_stranger(from(stranger, kHeartbeat, 0, heartbeat(stranger, 1, 5))));
    pass(announcement_of(stranger).octets());
    now += 1ms;
  }
  CHECK(guard.participants() <= Admission::kMaxParticipants);
  const std::int64_t far = std::int64_t{1} << 50;
  CHECK(passes(from(kWriter, kHeartbeat, 0, heartbeat(kWriter, 1, 5))));
  CHECK(refuses(from(kWriter, kHeartbeat, 0, heartbeat(kWriter, far, far)), Refusal::Leap));
}

TEST_CASE("numbers that a reader counts one by one are skipped in parts, of which each is true") {
  Stage stage(SkippedNumbers::Counted);
  const auto leap = [](std::int64_t to) {
    return from(kWriter, kHeartbeat, 0, heartbeat(kWriter, to, to));
  };
  const std::int64_t far = std::int64_t{1} << 32;
  const std::int64_t at_once =
      Admission::kCountedOfParticipant.at_once + Admission::kCountedOfSource.at_once;
  CHECK(stage.pass(leap(far).octets()) ==
        from(kWriter, kHeartbeat, 0, heartbeat(kWriter, at_once + 1, at_once)).octets());
  CHECK(stage.refuses(leap(far), Refusal::Leap));
  stage.now += 1s;
  const std::int64_t a_second =
      Admission::kCountedOfParticipant.a_second + Admission::kCountedOfSource.at_once;
  CHECK(stage.pass(leap(far).octets()) ==
        from(kWriter, kHeartbeat, 0, heartbeat(kWriter, at_once + a_second + 1, at_once + a_second))
            .octets());
}

TEST_CASE("a late joiner that counts gets to a writer's three millionth sample in seconds") {
  Stage stage(SkippedNumbers::Counted);
  const auto beat = from(kWriter, kHeartbeat, 0, heartbeat(kWriter, 3'000'000, 3'000'010));
  int beats = 1;
  while (!stage.passes(beat)) {
    stage.now += 100ms;
    REQUIRE(++beats < 70);
  }
  CHECK(beats > 10);
}

TEST_CASE("what one address lets skip keeps no participant from its own start") {
  Stage stage(SkippedNumbers::Counted);
  const std::int64_t far = std::int64_t{1} << 32;
  for (int i = 0; i < 20; ++i) {
    stage.pass(from(kWriter, kHeartbeat, 0, heartbeat(kWriter, far, far)).octets());
  }
  const Guid other = stranger_of(7);
  CHECK(stage.passes(announcement_of(other)));
  CHECK(stage.passes(from(other, kHeartbeat, 0, heartbeat(other, 10'000, 10'003))));
}

TEST_CASE("a reader that lacks a number is given few behind it that do not exist") {
  Stage stage(SkippedNumbers::Counted);
  constexpr std::int64_t kFar = 900'000;
  REQUIRE(stage.passes(from(kWriter, kHeartbeat, 0, heartbeat(kWriter, 1, kFar))));
  // Number 1 is missing: without limit each of these would cost the reader 65,536 entries.
  std::int64_t skipped = 0;
  for (std::int64_t start = 2; start < kFar; start += 65'536) {
    skipped +=
        !stage.pass(from(kWriter, kGap, 0, gap(kWriter, start, start + 65'535)).octets()).empty();
  }
  CHECK(skipped == 1);
  CHECK(stage.pass(from(kWriter, kGap, 0, gap(kWriter, 2, 60'000)).octets()) ==
        from(kWriter, kGap, 0, gap(kWriter, 2, Admission::kGapAhead + 1)).octets());
  // It has acknowledged all up to there, and asks for the rest.
  stage.acknowledge(kWriter, 4096);
  CHECK(stage.pass(from(kWriter, kGap, 0, gap(kWriter, 4097, kFar)).octets()) ==
        from(kWriter, kGap, 0, gap(kWriter, 4097, 4097 + 65'536)).octets());
  CHECK(stage.refuses(from(kWriter, kGap, 0, gap(kWriter, 70'000, 80'000)), Refusal::Leap));
}

TEST_CASE_METHOD(
    Stage,
    "an address has room for twice as many participants as find ports there, and they come one by "
    "one") {
  const auto announce = [&](unsigned number, std::uint32_t source) {
    return !pass(announcement_of(stranger_of(number)).octets(), source).empty();
  };
  constexpr auto kAtOnce = static_cast<unsigned>(Admission::kNewcomersOfSource.at_once);
  unsigned accepted = 0;
  for (unsigned i = 0; i < 1000; ++i) accepted += announce(i, kSomewhere);
  CHECK(accepted == kAtOnce);
  CHECK(announce(5000, kSomewhere + 1));  // others have theirs
  CHECK(announce(0, kSomewhere));         // who is known may say it again
  for (int second = 0; second < 60; ++second) {
    now += 1s;
    for (unsigned i = 0; i < 1000; ++i) {
      // The vendor has found them all.
      if (announce(i, kSomewhere)) guard.found(stranger_of(i).participant());
    }
  }
  CHECK(guard.participants() == Admission::kMaxParticipantsOfSource);
  CHECK_FALSE(announce(2000, kSomewhere));
  guard.removed(stranger_of(0).participant());
  CHECK(announce(2000, kSomewhere));
}

TEST_CASE_METHOD(
    Stage, "participants that the vendor never finds are forgotten when others need their room") {
  const auto announce = [&](unsigned number) {
    return !pass(announcement_of(stranger_of(number)).octets()).empty();
  };
  unsigned number = 0;
  while (guard.participants() < 1 + Admission::kMaxParticipantsOfSource) {
    announce(++number);
    now += 10ms;
  }
  now += 1s;
  CHECK_FALSE(announce(100'000));
  now += Admission::kUnconfirmed;
  CHECK(announce(100'000));
}

TEST_CASE_METHOD(Stage,
                 "writers that participants invent are bounded, and leave others room for theirs") {
  std::size_t all = 0;
  for (unsigned rogue = 1; rogue <= 8; ++rogue) {
    pass(announcement_of(stranger_of(rogue)).octets());
    for (std::uint32_t number = 0; number < 5000; ++number) {
      const Guid writer = with_entity(stranger_of(rogue), number << 8 | 0x03);
      all += passes(from(writer, kHeartbeat, 0, heartbeat(writer, 1, 5)));
    }
  }
  CHECK(all <= Admission::kMaxWritersInAll);
  CHECK(all > Admission::kMaxWriters);
  CHECK(passes(from(kWriter, kHeartbeat, 0, heartbeat(kWriter, 1, 5))));
  guard.removed(stranger_of(1).participant());
  const Guid another = stranger_of(9);
  pass(announcement_of(another).octets());
  CHECK(passes(from(another, kHeartbeat, 0, heartbeat(another, 1, 5))));
}

TEST_CASE_METHOD(
    Stage,
    "what a participant announces is bounded, and free again when the vendor has removed it") {
  constexpr std::size_t kSize = 60'000;
  std::uint32_t source = kSomewhere;
  const auto announces = [&](const InventedPeer& peer, std::uint32_t number, std::size_t data = 0) {
    const auto packet = peer.endpoint(peer.writer(number), "topic", "type", number, data);
    return pass(packet.octets(), source) == packet.octets();
  };
  const auto announce_all = [&](const InventedPeer& peer, std::size_t data = 0) {
    REQUIRE_FALSE(pass(peer.announcement().octets(), source).empty());
    std::uint32_t number = 1;
    while (announces(peer, number, data)) ++number;
    return number - 1;
  };
  const InventedPeer peer(1, kSomewhere);
  SECTION("by their number") {
    const std::uint32_t all = announce_all(peer);
    CHECK(all > 9'000);  // 1,000 services, each with eight clients
    CHECK(all * Admission::kKeptOfEach <= Admission::kMaxAnnounced);
    CHECK(announces(peer, 1));  // those that are known may be said again
    // Whether the vendor takes a withdrawal is the vendor's to say.
    pass(peer.withdrawal(peer.writer(1), all + 1).octets());
    CHECK_FALSE(announces(peer, all + 2));
    guard.endpoint_removed(peer.writer(1));
    CHECK(announces(peer, all + 2));
    // It was announced anew in the meantime.
    guard.endpoint_found(peer.writer(1));
    guard.endpoint_removed(peer.writer(2));
    CHECK_FALSE(announces(peer, all + 3));
  }
  SECTION("by their size") {
    const std::uint32_t all = announce_all(peer, kSize);
    CHECK(all * kSize <= Admission::kMaxAnnounced);
    CHECK(all > 500);
  }
  SECTION("of all at an address, and in all") {
    std::uint32_t rogue = 0;
    std::size_t all = 0;
    for (std::uint32_t address = kSomewhere; address < kSomewhere + 3; ++address) {
      source = address;
      const std::size_t before = all;
      for (int i = 0; i < 6; ++i)
        all += announce_all(InventedPeer(++rogue, address), kSize) * kSize;
      CHECK(all - before <= Admission::kMaxAnnouncedAtSource);
    }
    CHECK(all <= Admission::kMaxAnnouncedInAll);
    CHECK(all > Admission::kMaxAnnouncedInAll * 9 / 10);
    guard.removed(InventedPeer(1).entity(0).participant());
    source = kSomewhere;
    CHECK(announce_all(InventedPeer(100, source), kSize) > 500);
  }
}

TEST_CASE(
    "few announcements wait for a vendor that looks through them, until it has acknowledged") {
  Stage stage(SkippedNumbers::Counted);
  const InventedPeer peer(1, kSomewhere);
  REQUIRE(stage.passes(peer.announcement()));
  const auto announces = [&](std::int64_t number) {
    return stage.passes(peer.endpoint(peer.writer(1), "topic", "type", number));
  };
  std::int64_t number = 2;  // the first one is missing
  while (announces(number)) ++number;
  CHECK(number <= Admission::kMaxWaiting + 3);
  CHECK(number > 4000);
  CHECK(announces(1));
  stage.acknowledge(peer.entity(entity_id::kPublicationsAnnouncer), number - 1);
  CHECK(announces(number));
  CHECK(announces(number + 1));
}
