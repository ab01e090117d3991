// What the guard hands on by what was received of its sender before.
#include <catch2/catch.hpp>

#include "guard_stage.hpp"

using namespace skein;
using namespace skein::test;
using namespace skein::test::guard_stage;
using dds::Admission;
using dds::RtpsGuard;
using dds::SkippedNumbers;
using Refusal = RtpsGuard::Refusal;
using namespace std::chrono_literals;

TEST_CASE("a heartbeat that leaps by 2^52 is refused, of a writer known or unknown") {
  Stage stage;
  const auto leap = [](const Guid& writer) {
    const std::int64_t far = std::int64_t{1} << 52;
    return from(writer, kHeartbeat, 0, heartbeat(writer, far, far));
  };
  CHECK(stage.refuses(leap(writer_of(2)), Refusal::Leap));
  CHECK(stage.passes(from(kWriter, kHeartbeat, 0, heartbeat(kWriter, 1, 5))));
  CHECK(stage.refuses(leap(kWriter), Refusal::Leap));
  CHECK(stage.passes(from(kWriter, kHeartbeat, 0, heartbeat(kWriter, 1, 6))));
}

TEST_CASE("a late joiner hears of a writer that has written a billion samples") {
  Stage stage;
  const std::int64_t billion = 1'000'000'000;
  CHECK(stage.passes(from(kWriter, kHeartbeat, 0, heartbeat(kWriter, billion, billion))));
  CHECK(stage.passes(from(kWriter, kData, kHasPayload, data(kWriter, billion + 1, kPayload))));
}

TEST_CASE("who was cut off may have missed a million samples a second") {
  Stage stage;
  CHECK(stage.passes(from(kWriter, kHeartbeat, 0, heartbeat(kWriter, 1, 5))));
  const std::int64_t missed = 60'000'000;
  const auto beat = from(kWriter, kHeartbeat, 0, heartbeat(kWriter, missed, missed));
  CHECK(stage.refuses(beat, Refusal::Leap));
  stage.now += 60s;
  CHECK(stage.passes(beat));
  CHECK(stage.refuses(from(kWriter, kHeartbeat, 0, heartbeat(kWriter, 1, 2 * missed)),
                      Refusal::Leap));
}

TEST_CASE("a gap is within what was announced, and no longer than a reader can count through") {
  Stage stage;
  const std::int64_t last = 900'000;
  REQUIRE(stage.passes(from(kWriter, kHeartbeat, 0, heartbeat(kWriter, 1, last))));
  CHECK(stage.passes(from(kWriter, kGap, 0, gap(kWriter, 3, 4000))));
  CHECK(stage.refuses(from(kWriter, kGap, 0, gap(kWriter, 1'000'000, std::int64_t{1} << 40)),
                      Refusal::Leap));
  CHECK(stage.refuses(from(kWriter, kGap, 0, gap(kWriter, 0, 5)), Refusal::Form));
  CHECK(stage.refuses(from(kWriter, kGap, 0, gap(kWriter, 5, 4)), Refusal::Form));
  // The reader asks again for the rest.
  CHECK(stage.pass(from(kWriter, kGap, 0, gap(kWriter, 2, last)).octets()) ==
        from(kWriter, kGap, 0, gap(kWriter, 2, 2 + 65536)).octets());
}

TEST_CASE("all fragments of a sample agree on its size and theirs") {
  Stage stage;
  const auto fragment = [&](const FragmentClaim& claim) {
    return from(kWriter, kDataFrag, 0, data_frag(kWriter, 7, claim, 4096));
  };
  CHECK(stage.passes(fragment({1, 1, 1024, 60'000})));
  CHECK(stage.refuses(fragment({2, 1, 1024, 6'000}), Refusal::Fragment));
  CHECK(stage.refuses(fragment({2, 1, 2048, 60'000}), Refusal::Fragment));
  CHECK(stage.passes(fragment({2, 1, 1024, 60'000})));
}

TEST_CASE("only who is matched may begin a sample in fragments") {
  Stage stage;
  const Guid other = writer_of(2);
  CHECK(stage.refuses(stage.begins(other, 1, 100'000), Refusal::Unmatched));
  stage.match(other);
  CHECK(stage.passes(stage.begins(other, 1, 100'000)));
  stage.match(other, false);
  CHECK(stage.refuses(stage.begins(other, 1, 100'000), Refusal::Unmatched));
  stage.guard.reader_gone(dds::rtps_message::entity_of(kReader));
  CHECK(stage.refuses(stage.begins(kWriter, 1, 100'000), Refusal::Unmatched));
}

TEST_CASE("what may be begun depends on what was received: a claim of 256 MiB is no reason") {
  Stage stage;
  constexpr std::uint32_t kLargest = Admission::kLargestSample;
  CHECK(stage.refuses(stage.begins(kWriter, 1, kLargest + 1), Refusal::Room));
  CHECK(stage.refuses(stage.begins(kWriter, 1, kLargest), Refusal::Room));
  // Who really sends so much is refused a part of it, which the reader asks for again.
  const std::uint32_t fragments = (kLargest + 59'999) / 60'000;
  std::uint32_t refused = 0;
  for (std::uint32_t i = 1; i < fragments; ++i) {
    refused += !stage.passes(
        from(kWriter, kDataFrag, 0, data_frag(kWriter, 1, {i, 1, 60'000, kLargest}, 60'000)));
  }
  CHECK(refused > 0);
  CHECK(refused * Admission::kAhead <= fragments);
}

TEST_CASE("small claims of one participant leave others their room, from the same address too") {
  Stage stage;
  const Guid rogue = stranger_of(1);
  stage.pass(announcement_of(rogue).octets(), kHere);
  stage.match(rogue);
  for (int i = 1; i <= 20'000; ++i) {
    const FragmentClaim claim{1, 1, 256, 20'000'000};
    stage.pass(from(rogue, kDataFrag, 0, data_frag(rogue, i, claim, 256)).octets(), kHere);
  }
  // What kWriter begins it has to earn now.
  std::uint32_t refused = 0;
  for (std::uint32_t i = 1; i <= 17; ++i) {
    refused += !stage.passes(
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

TEST_CASE("samples that are complete claim nothing") {
  Stage stage;
  for (int i = 1; i <= 20'000; ++i) {
    REQUIRE(stage.passes(
        from(kWriter, kDataFrag, 0, data_frag(kWriter, i, {1, 1, 60'000, 60'000}, 60'000))));
  }
}

TEST_CASE("who has not announced itself is not heard") {
  Stage stage;
  const Guid stranger = stranger_of(1);
  const auto acknack = entities({}, stranger).number(1).u32(0).u32(7);
  const auto heard = [&](bool (Stage::*judged)(const RtpsPacket&)) {
    return (stage.*judged)(from(stranger, kHeartbeat, 0, heartbeat(stranger, 1, 5))) &&
           (stage.*judged)(from(stranger, kData, kHasPayload, data(stranger, 1, kPayload))) &&
           (stage.*judged)(from(stranger, kGap, 0, gap(stranger, 1, 3))) &&
           (stage.*judged)(from(stranger, 0x06, 0, acknack));
  };
  CHECK(heard(&Stage::refuses_stranger));
  CHECK(stage.passes(announcement_of(stranger)));
  CHECK(heard(&Stage::passes));
  stage.guard.removed(stranger.participant());
  CHECK(heard(&Stage::refuses_stranger));
  stage.guard.found(stranger.participant());
  CHECK(heard(&Stage::passes));
}

TEST_CASE("a flood of strangers takes no memory, and none of those that are there forgotten") {
  Stage stage;
  CHECK(stage.passes(from(kWriter, kHeartbeat, 0, heartbeat(kWriter, 1, 5))));
  stage.guard.found(kWriter.participant());
  for (unsigned i = 0; i < 100'000; ++i) {
    const Guid stranger = stranger_of(i);
    REQUIRE(stage.refuses_stranger(from(stranger, kHeartbeat, 0, heartbeat(stranger, 1, 5))));
    stage.pass(announcement_of(stranger).octets());
    stage.now += 1ms;
  }
  CHECK(stage.guard.participants() <= Admission::kMaxParticipants);
  const std::int64_t far = std::int64_t{1} << 50;
  CHECK(stage.passes(from(kWriter, kHeartbeat, 0, heartbeat(kWriter, 1, 5))));
  CHECK(stage.refuses(from(kWriter, kHeartbeat, 0, heartbeat(kWriter, far, far)), Refusal::Leap));
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

TEST_CASE(
    "an address has room for twice as many participants as find ports there, and they come one by "
    "one") {
  Stage stage;
  const auto announce = [&](unsigned number, std::uint32_t source) {
    return !stage.pass(announcement_of(stranger_of(number)).octets(), source).empty();
  };
  constexpr auto kAtOnce = static_cast<unsigned>(Admission::kNewcomersOfSource.at_once);
  unsigned accepted = 0;
  for (unsigned i = 0; i < 1000; ++i) accepted += announce(i, kSomewhere);
  CHECK(accepted == kAtOnce);
  CHECK(announce(5000, kSomewhere + 1));  // others have theirs
  CHECK(announce(0, kSomewhere));         // who is known may say it again
  for (int second = 0; second < 60; ++second) {
    stage.now += 1s;
    for (unsigned i = 0; i < 1000; ++i) {
      // The vendor has found them all.
      if (announce(i, kSomewhere)) stage.guard.found(stranger_of(i).participant());
    }
  }
  CHECK(stage.guard.participants() == Admission::kMaxParticipantsOfSource);
  CHECK_FALSE(announce(2000, kSomewhere));
  stage.guard.removed(stranger_of(0).participant());
  CHECK(announce(2000, kSomewhere));
}

TEST_CASE("participants that the vendor never finds are forgotten when others need their room") {
  Stage stage;
  const auto announce = [&](unsigned number) {
    return !stage.pass(announcement_of(stranger_of(number)).octets()).empty();
  };
  unsigned number = 0;
  while (stage.guard.participants() < 1 + Admission::kMaxParticipantsOfSource) {
    announce(++number);
    stage.now += 10ms;
  }
  stage.now += 1s;
  CHECK_FALSE(announce(100'000));
  stage.now += Admission::kUnconfirmed;
  CHECK(announce(100'000));
}

TEST_CASE("writers that participants invent are bounded, and leave others room for theirs") {
  Stage stage;
  std::size_t all = 0;
  for (unsigned rogue = 1; rogue <= 8; ++rogue) {
    stage.pass(announcement_of(stranger_of(rogue)).octets());
    for (std::uint32_t number = 0; number < 5000; ++number) {
      const Guid writer = with_entity(stranger_of(rogue), number << 8 | 0x03);
      all += stage.passes(from(writer, kHeartbeat, 0, heartbeat(writer, 1, 5)));
    }
  }
  CHECK(all <= Admission::kMaxWritersInAll);
  CHECK(all > Admission::kMaxWriters);
  CHECK(stage.passes(from(kWriter, kHeartbeat, 0, heartbeat(kWriter, 1, 5))));
  stage.guard.removed(stranger_of(1).participant());
  const Guid another = stranger_of(9);
  stage.pass(announcement_of(another).octets());
  CHECK(stage.passes(from(another, kHeartbeat, 0, heartbeat(another, 1, 5))));
}
