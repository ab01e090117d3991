// What the judge decides about one submessage, at times that the test tells.
#include "dds/rtps/submessage_judge.hpp"

#include <catch2/catch.hpp>

#include "guard_stage.hpp"

using namespace skein;
using namespace skein::test;
using namespace skein::test::guard_stage;
using dds::Refusal;
using dds::SubmessageJudge;
using namespace std::chrono_literals;

namespace {

struct Judging {
  /// The verdict on the first submessage of `packet`, which becomes as the judge leaves it.
  SubmessageJudge::Verdict judge(const RtpsPacket& packet, const Guid& sender = kWriter) {
    octets = packet.octets();
    const auto submessage = dds::rtps_message::submessage_at(octets.data(), octets.size(), 20);
    REQUIRE(submessage);
    return judging.judge(*submessage, {sender.participant(), kHere, now});
  }

  const dds::Addresses addresses;
  dds::Admission admission{dds::SkippedNumbers::Noted};
  SubmessageJudge judging{addresses, admission};
  Octets octets;
  dds::Admission::Time now{1h};
};

}  // namespace

TEST_CASE("only PAD, INFO_TS and INFO_DST are judged by their form alone") {
  const auto by_form = [](unsigned kind, const OctetWriter& body) {
    Octets octets = from(kWriter, kind, 0, body).octets();
    return SubmessageJudge::judge_form(
        *dds::rtps_message::submessage_at(octets.data(), octets.size(), 20));
  };
  using Judged = std::optional<SubmessageJudge::Verdict>;
  const Judged sound{SubmessageJudge::Verdict{}};
  const Judged refused{SubmessageJudge::Verdict{Refusal::Form}};
  REQUIRE(sound.has_value());
  CHECK(by_form(0x01, OctetWriter().zeros(4)) == sound);
  CHECK(by_form(0x09, OctetWriter().zeros(8)) == sound);
  CHECK(by_form(0x09, OctetWriter().zeros(4)) == refused);
  CHECK(by_form(0x0e, OctetWriter().zeros(12)) == sound);
  CHECK(by_form(0x0e, OctetWriter().zeros(8)) == refused);
  for (unsigned kind = 0; kind < 0x100; ++kind) {
    CAPTURE(kind);
    const bool of_form = kind == 0x01 || kind == 0x09 || kind == 0x0e;
    CHECK(by_form(kind, OctetWriter().zeros(16)).has_value() == of_form);
  }
}

TEST_CASE_METHOD(Judging, "a participant that has not announced itself is a stranger") {
  const auto beat = from(kWriter, kHeartbeat, 0, heartbeat(kWriter, 1, 5));
  CHECK(judge(beat) == Refusal::Stranger);
  CHECK_FALSE(judge(announcement_of(kWriter)));
  CHECK_FALSE(judge(beat));
  CHECK(judge(from(kWriter, 0x7f, 0, OctetWriter().zeros(8))) == Refusal::Unused);
}

TEST_CASE_METHOD(Judging, "a gap that is too long becomes a shorter one, as true") {
  CHECK_FALSE(judge(announcement_of(kWriter)));
  CHECK_FALSE(judge(from(kWriter, kHeartbeat, 0, heartbeat(kWriter, 1, 900'000))));
  CHECK_FALSE(judge(from(kWriter, kGap, 0, gap(kWriter, 2, 900'000))));
  CHECK(octets == from(kWriter, kGap, 0, gap(kWriter, 2, 2 + 65536)).octets());
}
