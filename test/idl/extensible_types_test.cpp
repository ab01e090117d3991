// Types that travel as XCDR2, and how they evolve.
#include <catch2/catch.hpp>

#include "beyond_idlc.idl.hpp"
#include "codec_check.hpp"
#include "extensible.idl.hpp"
#include "samples.hpp"

using namespace extensible;
using skein::Bytes;
using skein::idl::decode_message;
using skein::idl::encode_message;
using skein::idl::from_json;
using skein::idl::to_json;

TEST_CASE("each type comes back from both byte orders of XCDR2 and from JSON") {
  check_round_trips(samples::whole());
  check_round_trips(Whole{});
  check_round_trips(samples::part());
  check_round_trips(samples::part_later());
  check_round_trips(samples::report());
  check_round_trips(Report{});
  check_round_trips(samples::choice());
  check_round_trips(samples::extended_leaf());
  check_round_trips(Hashed{1, 2});
  Either either;
  check_round_trips(either);
  either.part({3, "part"});
  check_round_trips(either);
  either.select(9);
  check_round_trips(either);
}

TEST_CASE("long double is IEEE 754's binary128, on an alignment of eight bytes") {
  const Quads quads{1, 1.0L / 3, {-2.5L, std::numeric_limits<long double>::max(), 0}};
  check_round_trips(quads);
  CHECK(to_json(Quads{1, 0.1L, {}}) == R"({"before":1,"one":"0.1","more":[]})");
  CHECK(from_json<Quads>(R"({"before":1,"one":"0.1","more":["Infinity",-2.5]})") ==
        Quads{1, 0.1L, {std::numeric_limits<long double>::infinity(), -2.5L}});
  CHECK_THROWS_WITH(from_json<Quads>(R"({"before":1,"one":"0.1x","more":[]})"),
                    Catch::Contains("$.one is no number"));

  const Bytes message = encode_message(Quads{7, -2.5L, {}});
  std::vector<unsigned char> expected{0, 1, 0, 0, 7};
  expected.resize(32);
  expected[25] = 0x40;  // sign, exponent 1 and fraction 0.25 stand at the end of the number
  expected[27] = 0xC0;
  const auto* bytes = reinterpret_cast<const unsigned char*>(message.data());
  CHECK(std::vector(bytes, bytes + message.size()) == expected);
}

TEST_CASE("a message says by what it begins how it travels") {
  CHECK(encode_message(samples::whole()).data()[1] == std::byte{7});
  CHECK(encode_message(samples::part()).data()[1] == std::byte{9});
  CHECK(encode_message(samples::report()).data()[1] == std::byte{11});
  CHECK(encode_message(Point{}).data()[1] == std::byte{1});
}

TEST_CASE("a member that was appended is passed over by older readers and missed by newer ones") {
  const Part part = decode_message<Part>(encode_message(samples::part_later()));
  CHECK(part == Part{4, 2.5, "later"});
  const PartLater later = decode_message<PartLater>(encode_message(samples::part()));
  CHECK(later == PartLater{3, -0.5, "part", 7, {}});
}

TEST_CASE("members of a mutable type come in any order, unknown and missing ones do no harm") {
  const Report report = decode_message<Report>(encode_message(samples::report_later()));
  CHECK(report.number == 8);
  CHECK(report.value == 0.125);
  CHECK(report.samples == std::vector<std::int16_t>{6, 7});
  CHECK(!report.text);
  const ReportLater later = decode_message<ReportLater>(encode_message(samples::report()));
  CHECK(later.added == 3);
  CHECK(later.number == 5);
  CHECK(!later.where);
}

TEST_CASE("a member that must be understood is not passed over") {
  CHECK_THROWS_WITH(decode_message<Report>(encode_message(ReportThatMatters{1, 2})),
                    Catch::Contains("the member with the identifier 50 must be understood"));
}

TEST_CASE("what is absent is null in JSON and nothing in text") {
  Whole value;
  CHECK(to_json(value).find(R"("maybe":null,"text":null)") != std::string::npos);
  CHECK(to_string(value).find("maybe=nothing, text=nothing") != std::string::npos);
  value.maybe = 0.5;
  CHECK(to_json(value).find(R"("maybe":0.5)") != std::string::npos);
}

TEST_CASE("a key of a type that travels as XCDR2 is aligned to four bytes") {
  // DDS-XTypes 1.3, 7.6.8: octet 2, three bytes of padding, the double 3.5.
  CHECK(key_hash(samples::extended_leaf()).hex() == "02000000400c00000000000000000000");
}
