// Types that IDL 4 has beyond CORBA's.
#include <catch2/catch.hpp>

#include "codec_check.hpp"
#include "modern.idl.hpp"
#include "samples.hpp"

namespace modern {

using skein::Bytes;
using skein::InvalidArgument;
using skein::idl::decode_message;
using skein::idl::encode_message;
using skein::idl::from_json;
using skein::idl::to_json;

TEST_CASE("each type comes back from CDR and from JSON as it went out") {
  check_round_trips(samples::leaf());
  check_round_trips(Leaf{});
  check_round_trips(samples::maps());
  check_round_trips(samples::wide_text());
  check_round_trips(samples::bits());
  check_round_trips(FromNothing{{}, 5});
  ByLetter letter;
  check_round_trips(letter);
  letter.text(samples::wide_text());
  check_round_trips(letter);
  ByNumber number;
  number.pairs({{1, 2}});
  check_round_trips(number);
  ByLevel level;
  level.y(-5);
  check_round_trips(level);
}

TEST_CASE("a bitmask is an enumeration with operators") {
  Flags flags = Flags::lit | Flags::ready;
  CHECK(static_cast<std::uint8_t>(flags) == 0x09);
  CHECK((flags & Flags::armed) == Flags{});
  flags ^= Flags::ready;
  CHECK(flags == Flags::lit);
  CHECK((~flags & Flags::lit) == Flags{});
  CHECK(BOTH == (Flags::lit | Flags::ready));
  CHECK(to_string(BOTH) == "[lit, ready]");
  CHECK(to_string(Flags{}) == "[]");
  CHECK(to_json(BOTH) == R"(["lit","ready"])");
}

TEST_CASE("bits of a bitmask that have no name are kept") {
  const auto unknown = static_cast<Flags>(0x42);
  CHECK(decode_message<Flags>(encode_message(unknown)) == unknown);
  CHECK(to_json(unknown | Flags::lit) == R"(["lit",66])");
  CHECK(from_json<Flags>(R"(["lit",66])") == (unknown | Flags::lit));
  CHECK(to_string(unknown | Flags::lit) == "[lit, 66]");
}

TEST_CASE("a value that its bit field cannot hold is refused") {
  CHECK_NOTHROW(from_json<Packet>(R"({"kind":7,"valid":true,"angle":-512,"number":0})"));
  CHECK_THROWS_AS(from_json<Packet>(R"({"kind":8,"valid":true,"angle":0,"number":0})"),
                  InvalidArgument);
  CHECK_THROWS_AS(from_json<Packet>(R"({"kind":7,"valid":true,"angle":-513,"number":0})"),
                  InvalidArgument);
  CHECK_THROWS_AS(from_json<Packet>(R"({"kind":7,"valid":true,"angle":512,"number":0})"),
                  InvalidArgument);
}

TEST_CASE("an enumeration with values travels as these and starts as its default or first one") {
  CHECK(static_cast<int>(Level::MIDDLE) == 6);
  CHECK(static_cast<int>(Level::UNSET) == -2);
  CHECK(Leaf{}.unset == Level::UNSET);
  CHECK(Leaf{}.phases[1][1] == Phase::CLIMB);
  CHECK(to_string(Level::BELOW) == "BELOW");
  CHECK(to_string(static_cast<Level>(3)) == "modern::Level(3)");
  CHECK(encode_message(Level::BELOW).size() == 4 + 2);
  CHECK_THROWS_AS(encode_message(static_cast<Level>(3)), InvalidArgument);
  Bytes message = encode_message(Level::LOW);
  message.data()[4] = std::byte{4};
  CHECK(refusal<Level>(message).find("4 is no value of the enumeration") != std::string::npos);
}

TEST_CASE("a struct that inherits has its base's members, and its defaults") {
  const Leaf leaf;
  CHECK(leaf.offset == -7);
  CHECK(leaf.name == "home");
  CHECK(leaf.level == Level::LOW);
  const Root& root = leaf;
  CHECK(root.id == 0);
  CHECK(to_string(samples::leaf()).starts_with("Leaf{id=-8, offset=-7, name="));
}

TEST_CASE("a map is a sequence of pairs without a key that is there twice") {
  const Maps value = samples::maps();
  CHECK(
      to_json(value).starts_with(R"({"ages":[{"key":"ann","value":5},{"key":"bob","value":-6}])"));
  CHECK(to_string(value).starts_with(
      R"(Maps{ages=[{key="ann", value=5}, {key="bob", value=-6}], deep=[{key=-1, value=[{key="")"));
  ByNumber number;
  number.pairs({{1, 2}, {3, 4}});
  Bytes message = encode_message(number);
  message.data()[4 + 16] = std::byte{1};  // The second key.
  CHECK(refusal<ByNumber>(message).find("a key is there twice") != std::string::npos);
  CHECK_THROWS_AS(
      from_json<Maps>(
          R"({"ages":[{"key":"a","value":1},{"key":"a","value":1}],"deep":[],"leaves":[]})"),
      InvalidArgument);
}

TEST_CASE("bounds hold for maps, their keys and wide text") {
  Maps maps;
  maps.ages = {{"a", 1}, {"b", 2}, {"c", 3}};
  CHECK_THROWS_AS(encode_message(maps), InvalidArgument);
  maps.ages = {{"longer", 1}};
  CHECK_THROWS_AS(encode_message(maps), InvalidArgument);
  WideText text;
  text.four = L"\U0001d11e\U0001d11e";
  CHECK_NOTHROW(encode_message(text));
  text.four += L"a";  // Five units of UTF-16.
  CHECK_THROWS_AS(encode_message(text), InvalidArgument);
}

TEST_CASE("wide text that UTF-16 cannot carry is refused, halves of pairs are kept") {
  WideText text = samples::wide_text();
  text.letter = L'\U0001d11e';
  CHECK_THROWS_AS(encode_message(text), InvalidArgument);
  text.letter = static_cast<wchar_t>(0xD834);
  CHECK(decode_message<WideText>(encode_message(text)) == text);
  text.text = static_cast<wchar_t>(0x110000);
  CHECK_THROWS_AS(encode_message(text), InvalidArgument);
  CHECK_NOTHROW(to_json(text));
  CHECK_NOTHROW(to_string(text));
  CHECK(to_json(samples::wide_text()) ==
        "{\"letter\":\"\u20ac\",\"text\":\"\u20ac\U0001d11e\",\"four\":\"four\",\"after\":0.5}");
}

TEST_CASE("wide text of an odd number of bytes is malformed") {
  WideText text;
  text.text = L"a";
  Bytes message = encode_message(text);
  message.data()[4 + 4] = std::byte{1};
  CHECK(refusal<WideText>(message).find("odd number") != std::string::npos);
}

TEST_CASE("constants have the types of the mapping") {
  CHECK(GREETING ==
        L"\u20ac"
        L"5");
  CHECK(LEAST == -128);
  CHECK(LEAST_LONG == std::numeric_limits<std::int32_t>::min());
}

}  // namespace modern
