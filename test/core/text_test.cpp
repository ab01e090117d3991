#include <catch2/catch.hpp>
#include <unordered_set>

#include "core/suggestion.hpp"
#include "skein/detail/bytes.hpp"
#include "skein/guid.hpp"

using namespace skein;

TEST_CASE("a name that is almost right gets a suggestion, a far one none") {
  const std::vector<std::string> known{"latency", "quality", "AStar"};
  CHECK(suggestion("latancy", known) == " (did you mean 'latency'?)");
  CHECK(suggestion("astar", known) == " (did you mean 'AStar'?)");
  CHECK(suggestion("ASatr", known) == " (did you mean 'AStar'?)");
  CHECK(suggestion("laod", std::vector<std::string>{"lamp", "load"}) ==
        " (did you mean 'load'?)");  // two letters exchanged
  CHECK(suggestion("colour", known).empty());
  CHECK(suggestion("", known).empty());
  CHECK(suggestion("latency", {}).empty());
}

TEST_CASE("a GUID survives its hexadecimal form, and nothing else is one") {
  const Guid guid = Guid::random();
  CHECK(Guid::from_hex(guid.hex()) == guid);
  CHECK(guid.hex().size() == 32);
  CHECK_FALSE(Guid::from_hex("12"));
  CHECK_FALSE(Guid::from_hex(std::string(31, '0') + "g"));
  CHECK_FALSE(Guid::from_hex(std::string(32, 'A')));
}

TEST_CASE("a GUID's participant is its first twelve bytes") {
  const Guid guid = *Guid::from_hex("000102030405060708090a0b0c0d0e0f");
  CHECK(guid.participant().hex() == "000102030405060708090a0b00000000");
}

TEST_CASE("random GUIDs differ") {
  std::unordered_set<Guid> seen;
  for (int i = 0; i < 1000; ++i) seen.insert(Guid::random());
  CHECK(seen.size() == 1000);
}

TEST_CASE("bytes keep their content while they grow") {
  Bytes bytes;
  for (int i = 0; i < 1000; ++i) {
    const std::byte value{static_cast<unsigned char>(i)};
    bytes.append(std::span(&value, 1));
  }
  REQUIRE(bytes.size() == 1000);
  bool same = true;
  for (int i = 0; i < 1000; ++i)
    same = same && bytes.data()[i] == std::byte{static_cast<unsigned char>(i)};
  CHECK(same);
  Bytes moved = std::move(bytes);
  CHECK(moved.size() == 1000);
  CHECK(bytes.empty());
}
