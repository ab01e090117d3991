// What the guard hands on by the form of each message; packet_admission_test.cpp has the rest.
#include <catch2/catch.hpp>
#include <cstdio>
#include <ctime>

#include "dds/rtps/repeated_messages.hpp"
#include "guard_stage.hpp"
#include "skein/error.hpp"
#include "test/tools/invented_peer.hpp"

using namespace skein;
using namespace skein::test;
using namespace skein::test::guard_stage;
using dds::Admission;
using dds::Refusal;
using dds::RtpsGuard;
using dds::SkippedNumbers;
using namespace std::chrono_literals;

TEST_CASE_METHOD(Stage, "a message that is no RTPS of version 2, or has no sender, is refused") {
  const auto good = from(kWriter, kHeartbeat, 0, heartbeat(kWriter, 1, 5));
  CHECK(passes(good));
  for (const std::size_t broken : {0u, 1u, 2u, 3u, 4u}) {
    Octets octets = good.octets();
    octets[broken] ^= 0x20;
    CHECK(pass(octets).empty());
  }
  CHECK(pass({good.octets().begin(), good.octets().begin() + 19}).empty());
  CHECK(refuses(from(Guid{}, kHeartbeat, 0, heartbeat(kWriter, 1, 5)), Refusal::Form));
}

TEST_CASE_METHOD(Stage,
                 "what follows a submessage that does not lie within its message is cut off") {
  RtpsPacket packet(kWriter);
  packet.submessage(kHeartbeat, 0, heartbeat(kWriter, 1, 5));
  const Octets good = packet.octets();
  packet.submessage(kHeartbeat, 0, heartbeat(kWriter, 1, 5), 2000);
  CHECK(pass(packet.octets()) == good);
  CHECK(guard.refused(Refusal::Form) == 1);
}

TEST_CASE("every submessage's body must hold its fields") {
  const auto acknack = entities({}, kWriter).number(1).u32(1).u32(0).u32(7);
  const auto nack_frag = entities({}, kWriter).number(1).u32(1).u32(1).u32(0).u32(7);
  const auto heartbeat_frag = entities({}, kWriter).number(1).u32(4).u32(7);
  const std::pair<unsigned, OctetWriter> kinds[] = {
      {0x06, acknack},
      {kHeartbeat, heartbeat(kWriter, 1, 5)},
      {kGap, gap(kWriter, 1, 3)},
      {0x09, OctetWriter().zeros(8)},
      {0x0e, OctetWriter().zeros(12)},
      {0x12, nack_frag},
      {0x13, heartbeat_frag},
      {kData, data(kWriter, 1, kPayload)},
      {kDataFrag, data_frag(kWriter, 2, {1, 1, 1024, 1024}, 1024)},
  };
  for (const auto& [kind, body] : kinds) {
    INFO("submessage " << kind);
    const unsigned flags = kind == kData ? kHasPayload : 0;
    Stage stage;
    CHECK(stage.passes(from(kWriter, kind, flags, body)));
    // The last number of a DATA's payload is not a field.
    const std::size_t needed = kind == kData ? 24 : body.octets().size();
    for (std::size_t size = 4; size < needed; size += 4) {
      const OctetWriter part = OctetWriter().append(std::span(body.octets()).first(size));
      INFO("cut off after " << size);
      CHECK(stage.refuses(from(kWriter, kind, flags, part), Refusal::Form));
    }
  }
}

TEST_CASE_METHOD(Stage,
                 "sets of numbers have at most 256 bits, which are there, and numbers that exist") {
  const auto acknack = [&](std::int64_t base, std::uint32_t bits, std::size_t words) {
    return from(kWriter, 0x06, 0,
                entities({}, kWriter).number(base).u32(bits).zeros(4 * words).u32(7));
  };
  CHECK(passes(acknack(1, 256, 8)));
  CHECK(passes(acknack(0, 0, 0)));
  CHECK(refuses(acknack(1, 257, 9), Refusal::Form));
  CHECK(refuses(acknack(1, 33, 1), Refusal::Form));
  CHECK(refuses(acknack(0, 1, 1), Refusal::Form));
  CHECK(refuses(acknack(-1, 1, 1), Refusal::Form));
  CHECK(refuses(acknack(INT64_MAX, 1, 1), Refusal::Form));
}

TEST_CASE_METHOD(Stage, "a heartbeat names an order of samples that exist") {
  const auto beat = [&](std::int64_t first, std::int64_t last) {
    return from(kWriter, kHeartbeat, 0, heartbeat(kWriter, first, last));
  };
  CHECK(passes(beat(1, 0)));
  CHECK(passes(beat(9, 8)));
  CHECK(refuses(beat(0, 0), Refusal::Form));
  CHECK(refuses(beat(-3, 8), Refusal::Form));
  CHECK(refuses(beat(9, 7), Refusal::Form));
}

TEST_CASE_METHOD(Stage, "fragments exist in their sample, and are there") {
  const auto fragment = [&](const FragmentClaim& claim, std::size_t payload) {
    return from(kWriter, kDataFrag, 0, data_frag(kWriter, 7, claim, payload));
  };
  CHECK(passes(fragment({1, 1, 1024, 2500}, 1024)));
  CHECK(passes(fragment({2, 2, 1024, 2500}, 1476)));
  CHECK(refuses(fragment({2, 2, 1024, 2500}, 1472), Refusal::Form));
  CHECK(refuses(fragment({0, 1, 1024, 2500}, 1024), Refusal::Form));
  CHECK(refuses(fragment({4, 1, 1024, 2500}, 1024), Refusal::Form));
  CHECK(refuses(fragment({3, 2, 1024, 2500}, 2048), Refusal::Form));
  CHECK(refuses(fragment({1, 0, 1024, 2500}, 1024), Refusal::Form));
  CHECK(refuses(fragment({1, 1, 0, 2500}, 1024), Refusal::Form));
  CHECK(refuses(fragment({1, 1, 1024, 0}, 1024), Refusal::Form));
  // 120 bytes that claim to be 100 MB in 1539 fragments.
  CHECK(refuses(fragment({1, 1539, 65000, 100'000'000}, 64), Refusal::Form));
}

TEST_CASE_METHOD(Stage,
                 "fragments too small for Fast DDS's list of those that are missing are refused") {
  for (const unsigned size : {1u, 3u, 5u, 64u}) {
    CHECK(refuses(from(kWriter, kDataFrag, 0, data_frag(kWriter, 7, {1, 1, size, 60'000}, 64)),
                  Refusal::Fragment));
  }
}

TEST_CASE_METHOD(
    Stage, "vendors' own submessages are passed over in silence, the message's others go on") {
  RtpsPacket packet(kWriter);
  packet.submessage(kHeartbeat, 0, heartbeat(kWriter, 1, 5));
  const Octets good = packet.octets();
  // As Fast DDS appends its statistics, and with four bytes behind, at which it aborts.
  packet.submessage(0x80, 0, OctetWriter().zeros(56));
  CHECK(pass(packet.octets()) == good);
  CHECK(guard.refused(Refusal::Unused) == 0);
  CHECK(pass(RtpsPacket(packet).append(OctetWriter().zeros(4)).octets()) == good);
  RtpsPacket alone(kWriter);
  alone.submessage(0x80, 0, OctetWriter().zeros(56)).append(OctetWriter().zeros(4));
  REQUIRE(alone.octets().size() == 84);
  CHECK(pass(alone.octets()).empty());
}

TEST_CASE_METHOD(
    Stage, "submessages of security, of replies to elsewhere and in another's name are dropped") {
  const auto beat = heartbeat(kWriter, 1, 5);
  for (const unsigned kind : {0x0du, 0x0fu, 0x30u, 0x31u, 0x32u, 0x33u, 0x34u, 0x02u}) {
    RtpsPacket packet(kWriter);
    packet.submessage(kind, 0, OctetWriter().zeros(24)).submessage(kHeartbeat, 0, beat);
    RtpsPacket padded(kWriter);
    padded.submessage(kPad, 0, OctetWriter().zeros(24)).submessage(kHeartbeat, 0, beat);
    CHECK(pass(packet.octets()) == padded.octets());
  }
  RtpsPacket renamed(kWriter);
  renamed.submessage(0x0c, 0, OctetWriter().zeros(20)).submessage(kHeartbeat, 0, beat);
  CHECK(pass(renamed.octets()).empty());
}

TEST_CASE_METHOD(Stage, "discovery's parameters, texts and lists lie within it") {
  const Guid announcer = announcer_of(kWriter);
  const auto announcement = [&](const OctetWriter& parameters) {
    const auto payload = list_with_lease(kWriter).append(parameters.octets());
    return from(announcer, kData, kHasPayload, data(announcer, 1, payload.octets()));
  };
  const auto parameter = [](unsigned id, const OctetWriter& value) {
    return OctetWriter()
        .u16(id)
        .u16(static_cast<unsigned>(value.octets().size()))
        .append(value.octets())
        .u16(1)
        .u16(0);
  };
  const auto text = [](std::uint32_t claimed, bool ended = true) {
    return OctetWriter().u32(claimed).u8('a').u8('b').u8('c').u8(ended ? 0 : 'd');
  };
  CHECK(passes(announcement(parameter(0x62, text(4)))));
  CHECK(passes(announcement(
      parameter(0x59, OctetWriter().u32(1).append(text(4).octets()).append(text(4).octets())))));
  const OctetWriter bad[] = {
      OctetWriter(),                            // no end
      OctetWriter().u16(0x62).u16(400).u32(0),  // longer than all
      OctetWriter().u16(0x62).u16(6).zeros(8),  // not aligned
      parameter(0x62, text(5)),                 // a text longer than its parameter
      parameter(0x62, text(4, false)),          // a text without an end
      parameter(0x62, text(0)),                 // nor a beginning
      parameter(0x59, OctetWriter().u32(2).append(text(4).octets()).append(text(4).octets())),
      parameter(0x59, OctetWriter().u32(0xffffffff)),
      parameter(0x29, OctetWriter().u32(0x40000000).append(text(4).octets())),
      parameter(0x2c, OctetWriter().u32(400)),
      parameter(0x73, OctetWriter().u32(0xffffffff)),
      parameter(0x31, OctetWriter().zeros(20)),
      parameter(0x02, OctetWriter().u32(0x80000000).u32(0)),
  };
  for (const OctetWriter& parameters : bad) {
    CHECK(refuses(announcement(parameters), Refusal::Parameters));
  }
  // A type's description is not looked at by anybody here.
  CHECK(pass(announcement(parameter(0x75, OctetWriter().zeros(16))).octets()) ==
        announcement(parameter(0x00, OctetWriter().zeros(16))).octets());
  CHECK(refuses(from(announcer, kDataFrag, 0, data_frag(announcer, 1, {1, 1, 1024, 1024}, 1024)),
                Refusal::Unused));
}

TEST_CASE_METHOD(Stage, "a name that is announced has at most 255 octets") {
  const InventedPeer peer(1, kSomewhere);
  REQUIRE(passes(peer.announcement()));
  const std::string longest(255, 'n');
  CHECK(passes(peer.endpoint(peer.writer(1), longest, longest, 1)));
  CHECK_FALSE(passes(peer.endpoint(peer.writer(1), longest + "n", "T", 2)));
  CHECK_FALSE(passes(peer.endpoint(peer.writer(1), "t", longest + "n", 2)));
  CHECK(guard.refused(Refusal::Parameters) == 2);
}

TEST_CASE_METHOD(Stage, "a participant says when it counts as gone") {
  const Guid announcer = announcer_of(kWriter);
  const auto announcement = [&](const Octets& payload) {
    return from(announcer, kData, kHasPayload, data(announcer, 1, payload));
  };
  CHECK(passes(announcement(list_with_lease(kWriter).append(kEndOfList).octets())));
  CHECK(refuses(announcement(list_of(kWriter).append(kEndOfList).octets()), Refusal::Lease));
  const auto half = list_of(kWriter).u16(0x02).u16(4).u32(60).append(kEndOfList);
  CHECK(refuses(announcement(half.octets()), Refusal::Parameters));
}

TEST_CASE_METHOD(
    Stage, "the guard says whether it passed an announcement of a participant, and an ACKNACK") {
  const Guid announcer = announcer_of(kWriter);
  const Octets parameters = list_with_lease(kWriter).append(kEndOfList).octets();
  const auto acknack = entities({}, kWriter).number(1).u32(0).u32(7);
  const auto pass = [&](const RtpsPacket& packet) {
    Octets message = packet.octets();
    return guard.pass(message.data(), message.size(), kSomewhere, now);
  };
  auto passed = pass(from(announcer, kData, kHasPayload, data(announcer, 1, parameters)));
  CHECK(passed.announces);
  CHECK_FALSE(passed.acknowledges);
  passed = pass(
      from(kWriter, 0x06, 0, acknack).submessage(kData, kHasPayload, data(kWriter, 1, kPayload)));
  CHECK_FALSE(passed.announces);
  CHECK(passed.acknowledges);
  // Refused: its parameters have no end.
  const Octets endless{0, 3, 0, 0};
  CHECK_FALSE(pass(from(announcer, kData, kHasPayload, data(announcer, 2, endless))).announces);
}

TEST_CASE("of a message in several buffers each submessage is seen, without a sample apart") {
  struct Buffer {
    const void* buffer;
    std::size_t size;
  };
  constexpr std::size_t kSample = 40;
  const Octets message = RtpsPacket(kWriter)
                             .submessage(0x09, 0, OctetWriter().zeros(8))
                             .submessage(kData, 0, OctetWriter().zeros(20 + kSample))
                             .submessage(kHeartbeat, 0, OctetWriter().zeros(28))
                             .octets();
  const std::size_t before_sample = message.size() - (4 + 28) - kSample;
  for (std::size_t sent_apart = 0; sent_apart <= kSample; ++sent_apart) {
    CAPTURE(sent_apart);
    const std::size_t first = message.size() - (4 + 28) - sent_apart;
    const std::vector<Buffer> buffers{{message.data(), first},
                                      {message.data() + first, sent_apart},
                                      {message.data() + first + sent_apart, 4 + 28}};
    std::vector<std::pair<int, std::size_t>> seen;
    dds::rtps_message::for_each_submessage(buffers, [&](const auto& submessage) {
      seen.emplace_back(submessage.kind(), submessage.size);
    });
    const std::vector<std::pair<int, std::size_t>> expected{
        {0x09, 8}, {kData, 20 + first - before_sample}, {kHeartbeat, 28}};
    CHECK(seen == expected);
  }
}

TEST_CASE_METHOD(Stage, "a message of liveliness holds what it says") {
  Guid participant = writer_of(0, 0xc2);
  participant.bytes[13] = 0x02;  // 0x000200c2
  const auto message = [&](unsigned encapsulation, std::uint32_t claimed) {
    const auto payload = OctetWriter()
                             .u8(0)
                             .u8(encapsulation)
                             .u16(0)
                             .append(prefix_of(kWriter))
                             .zeros(4)
                             .u32(claimed)
                             .zeros(4);
    return from(participant, kData, kHasPayload, data(participant, 1, payload.octets()));
  };
  CHECK(passes(message(1, 4)));
  CHECK(passes(message(3, 0)));  // as Fast DDS writes it
  CHECK(refuses(message(1, 5), Refusal::Parameters));
  CHECK(refuses(message(7, 0), Refusal::Parameters));
}

TEST_CASE_METHOD(Stage, "discovery speaks of its sender and of the sender's endpoints alone") {
  const Guid other = stranger_of(1);
  pass(announcement_of(other).octets());
  const auto guid = [](unsigned id, const Guid& whose) {
    return OctetWriter().u16(id).u16(16).append(whose.bytes);
  };
  const Octets gone = OctetWriter().u16(0x71).u16(4).u32(3u << 24).append(kEndOfList).octets();
  const auto says = [&](std::uint32_t announcer, unsigned flags, const OctetWriter& list) {
    const Guid writer = with_entity(kWriter, announcer);
    return from(writer, kData, flags, data(writer, 1, list.octets()));
  };
  const auto list = [](const OctetWriter& parameters) {
    return OctetWriter().u32(0x300).append(parameters.octets()).append(kEndOfList);
  };
  constexpr std::uint32_t kAnnouncers[] = {entity_id::kPublicationsAnnouncer,
                                           entity_id::kSubscriptionsAnnouncer};
  constexpr unsigned kKeyOnly = 0x08;
  for (const std::uint32_t announcer : kAnnouncers) {
    CHECK(passes(says(announcer, kHasPayload, list(guid(0x5a, kWriter)))));
    CHECK(refuses(says(announcer, kHasPayload, list(guid(0x5a, other))), Refusal::Foreign));
    const auto both = guid(0x5a, kWriter).append(guid(0x70, other).octets());
    CHECK(refuses(says(announcer, kHasPayload, list(both)), Refusal::Foreign));
    CHECK(refuses(says(announcer, kHasPayload, list({})), Refusal::Foreign));
    CHECK(passes(says(announcer, kHasInlineQos, guid(0x70, kWriter).append(gone))));
    CHECK(
        refuses(says(announcer, kHasInlineQos, guid(0x70, other).append(gone)), Refusal::Foreign));
    // As Cyclone withdraws: by a key as payload.
    const auto key = [&](const Guid& whose) {
      return OctetWriter().append(gone).append(list(guid(0x5a, whose)).octets());
    };
    CHECK(passes(says(announcer, kHasInlineQos | kKeyOnly, key(kWriter))));
    CHECK(refuses(says(announcer, kHasInlineQos | kKeyOnly, key(other)), Refusal::Foreign));
  }
  const std::uint32_t participants = entity_id::kParticipantAnnouncer;
  CHECK(passes(says(participants, kHasInlineQos, guid(0x70, kWriter).append(gone))));
  CHECK(
      refuses(says(participants, kHasInlineQos, guid(0x70, other).append(gone)), Refusal::Foreign));
  CHECK(refuses(says(participants, kHasPayload, list_with_lease(other).append(kEndOfList)),
                Refusal::Foreign));
  const auto alive = OctetWriter().u32(0x300).append(prefix_of(other)).zeros(12);
  CHECK(refuses(says(0x200c2, kHasPayload, alive), Refusal::Foreign));
}

TEST_CASE_METHOD(Stage, "no lease is longer than RTPS's default") {
  const Guid announcer = announcer_of(kWriter);
  const auto announcement = [&](std::uint32_t seconds) {
    const auto list = list_with_lease(kWriter, seconds).append(kEndOfList);
    return from(announcer, kData, kHasPayload, data(announcer, 1, list.octets()));
  };
  CHECK(passes(announcement(99)));
  CHECK(pass(announcement(101).octets()) == announcement(100).octets());
  CHECK(pass(announcement(0x7fffffff).octets()) == announcement(100).octets());  // never
}

TEST_CASE("a participant names its own address, one of the profile, or a group of DDS") {
  const dds::AllowedSources own({"10.0.0.1"});
  const dds::AllowedSources named({"10.0.0.1", "10.5.0.0/16"});
  Stage stage(SkippedNumbers::Noted, {{}, own, named});
  const Guid peer = stranger_of(1);
  const Guid announcer = announcer_of(peer);
  const auto locator = [](unsigned id, std::uint32_t address, std::uint32_t kind = 1) {
    OctetWriter writer = OctetWriter().u16(id).u16(24).u32(kind).u32(7410).zeros(12);
    for (int shift = 24; shift >= 0; shift -= 8) writer.u8(address >> shift & 0xff);
    return writer;
  };
  const auto announcement = [&](const OctetWriter& locators) {
    const auto list = list_with_lease(peer).append(locators.octets()).append(kEndOfList);
    return from(announcer, kData, kHasPayload, data(announcer, 1, list.octets()));
  };
  const auto both = [&](const OctetWriter& one, const OctetWriter& other) {
    return announcement(OctetWriter(one).append(other.octets()));
  };
  constexpr std::uint32_t kVictim = 10u << 24 | 66;
  constexpr std::uint32_t kOwn = 10u << 24 | 1;
  constexpr std::uint32_t kNamed = 10u << 24 | 5 << 16 | 9;
  constexpr std::uint32_t kGroup = 239u << 24 | 255 << 16 | 1;
  constexpr std::uint32_t kOtherGroup = 239u << 24 | 255 << 16 | 2;
  const auto true_one = locator(0x32, kSomewhere);
  CHECK(stage.passes(both(true_one, locator(0x31, kSomewhere))));
  CHECK(stage.passes(both(true_one, locator(0x31, kNamed))));
  CHECK(stage.passes(both(true_one, locator(0x33, kGroup))));
  CHECK(stage.passes(both(true_one, locator(0x31, 0, 16))));
  const auto padded = [&](const OctetWriter& wrong) {
    Octets padding = wrong.octets();
    padding[0] = padding[1] = 0;
    return stage.pass(both(true_one, wrong).octets()) ==
           both(true_one, OctetWriter().append(padding)).octets();
  };
  for (const unsigned id : {0x2fu, 0x30u, 0x31u, 0x32u, 0x33u, 0x48u}) {
    INFO(id);
    CHECK(padded(locator(id, kVictim)));
    CHECK(padded(locator(id, kOwn)));
    CHECK(padded(locator(id, kOtherGroup)));
    CHECK(padded(locator(id, kSomewhere, 4)));
  }
  CHECK(stage.refuses(announcement(locator(0x32, kVictim)), Refusal::Locator));
  // On this host it may be either.
  CHECK(!stage.pass(announcement(locator(0x32, kOwn)).octets(), kOwn).empty());
  // From where it has announced itself, too: it has two interfaces.
  CHECK(!stage.pass(announcement(locator(0x32, kVictim)).octets(), kVictim).empty());
  CHECK(stage.passes(both(true_one, locator(0x31, kVictim))));
  // And its endpoints have no others.
  const Guid endpoints = with_entity(peer, entity_id::kPublicationsAnnouncer);
  const auto endpoint = [&](const OctetWriter& place) {
    const auto list = OctetWriter()
                          .u32(0x300)
                          .u16(0x5a)
                          .u16(16)
                          .append(with_entity(peer, 0x103).bytes)
                          .append(place.octets())
                          .append(kEndOfList);
    return from(endpoints, kData, kHasPayload, data(endpoints, 1, list.octets())).octets();
  };
  CHECK(stage.pass(endpoint(locator(0x2f, kSomewhere))) == endpoint(locator(0x2f, kSomewhere)));
  CHECK(stage.pass(endpoint(locator(0x2f, kVictim + 1))) != endpoint(locator(0x2f, kVictim + 1)));
}

TEST_CASE("packets come from allowed sources and this host only") {
  Stage stage(SkippedNumbers::Noted, {dds::AllowedSources({"10.0.0.0/24", "10.1.2.3"}), {}, {}});
  const Octets good = from(kWriter, kHeartbeat, 0, heartbeat(kWriter, 1, 5)).octets();
  CHECK(stage.pass(good, 0x0a000007) == good);
  CHECK(stage.pass(good, 0x0a010203) == good);
  CHECK(stage.pass(good, 0x7f000001) == good);
  CHECK(stage.pass(good, 0x0a000107).empty());
  CHECK(stage.pass(good, 0x0a010204).empty());
  CHECK(stage.guard.refused(Refusal::Source) == 2);
  for (const char* wrong : {"", "10.0.0", "10.0.0.1/33", "10.0.0.1/", "10.0.0.1/8x", "host"}) {
    INFO(wrong);
    CHECK_THROWS_AS(dds::AllowedSources({wrong}), InvalidArgument);
  }
}

TEST_CASE("of a vendor's messages about like packets the 1st, the 10th, the 100th are told") {
  dds::RepeatedMessages messages;
  std::vector<std::string> told;
  for (int i = 1; i <= 100; ++i) {
    if (const auto text = messages.next("bad packet " + std::to_string(i))) told.push_back(*text);
  }
  CHECK(told == std::vector<std::string>{"bad packet 1",
                                         "bad packet 10 (messages like this so far: 10)",
                                         "bad packet 100 (messages like this so far: 100)"});
  CHECK(messages.next("other packet") == "other packet");
}

TEST_CASE("what is told of a vendor's messages is bounded, however many kinds there are") {
  dds::RepeatedMessages messages;
  int told = 0;
  for (int i = 0; i < 100'000; ++i) {
    told += messages.next(std::string(1 + i % 1000, 'x')).has_value();
  }
  CHECK(told < 1000);
}

TEST_CASE_METHOD(Stage, "what the guard costs a packet", "[.benchmark]") {
  const auto time = [&](const char* what, const RtpsPacket& packet) {
    constexpr int kPackets = 1'000'000;
    Octets message = packet.octets();
    const std::clock_t start = std::clock();
    for (int i = 0; i < kPackets; ++i) {
      guard.pass(message.data(), message.size(), kSomewhere, RtpsGuard::Clock::now());
    }
    const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    std::printf("%-40s %6.0f ns of CPU time\n", what, seconds / kPackets * 1e9);
  };
  RtpsPacket call(kWriter);
  call.submessage(0x0e, 0, OctetWriter().zeros(12))
      .submessage(0x09, 0, OctetWriter().zeros(8))
      .submessage(kData, kHasPayload, data(kWriter, 5, Octets(100)))
      .submessage(kHeartbeat, 0, heartbeat(kWriter, 1, 5));
  // As all that stand in the table are.
  for (unsigned i = 0; i < 100; ++i) pass(announcement_of(stranger_of(i)).octets());
  time("INFO_DST, INFO_TS, DATA and HEARTBEAT", call);
  time("HEARTBEAT", from(kWriter, kHeartbeat, 0, heartbeat(kWriter, 1, 5)));
  time("DATA_FRAG", from(kWriter, kDataFrag, 0, data_frag(kWriter, 5, {1, 1, 8192, 60'000}, 8192)));
}
