#include <catch2/catch.hpp>
#include <random>

#include "allocation_meter.hpp"
#include "beyond_idlc.idl.hpp"
#include "codec_check.hpp"
#include "planner.idl.hpp"
#include "samples.hpp"

using skein::Bytes;
using skein::TypeSupport;
using skein::idl::ByteOrder;
using skein::idl::CdrReader;
using skein::idl::CdrWriter;
using skein::idl::decode_message;
using skein::idl::encode_message;
using skein::idl::MalformedSample;

namespace {

Bytes message_of(std::initializer_list<unsigned> values) {
  Bytes message;
  for (const unsigned value : values) {
    const std::byte byte{static_cast<unsigned char>(value)};
    message.append({&byte, 1});
  }
  return message;
}

std::string hex(std::span<const std::byte> bytes) {
  std::string text;
  for (const std::byte byte : bytes) {
    constexpr char digits[] = "0123456789abcdef";
    text += digits[std::to_integer<unsigned>(byte) >> 4];
    text += digits[std::to_integer<unsigned>(byte) & 15];
  }
  return text;
}

/// A message and what decodes it, for every kind of type.
struct Specimen {
  Bytes message;
  const TypeSupport* support;
};

template <class T>
Specimen specimen(const T& value) {
  return {encode_message(value), &skein::idl::type_support<T>()};
}

std::vector<Specimen> specimens() {
  std::vector<Specimen> made;
  made.push_back(specimen(samples::basic()));
  made.push_back(specimen(samples::compound()));
  made.push_back(specimen(samples::choices()));
  made.push_back(specimen(samples::tree()));
  made.push_back(specimen(samples::whole()));
  made.push_back(specimen(samples::report()));
  made.push_back(specimen(samples::part_later()));
  made.push_back(specimen(samples::choice()));
  made.push_back(specimen(test_planner::Route{{{1, 2, 3}}, 4, "five"}));
  made.push_back(specimen(skein::ServiceReference{"A/I", {}, "x"}));
  return made;
}

/// Decodes; whatever is no MalformedSample fails the test. Returns the memory that was allocated.
std::size_t decode_hostile(const Specimen& specimen, std::span<const std::byte> message) {
  void* value = specimen.support->make();
  const AllocationMeter meter;
  try {
    specimen.support->decode(value, message, 4);
  } catch (const MalformedSample&) {
  }
  const std::size_t allocated = meter.allocated();
  specimen.support->destroy(value);
  return allocated;
}

/// What a hostile message of that size may cost: a small multiple, and the text of an error.
std::size_t allowance(std::size_t message_size) { return 64 * message_size + 4096; }

}  // namespace

TEST_CASE("a message is PLAIN_CDR, little-endian, aligned from its fifth byte, padded with zeros") {
  const test_planner::Route route{{{1, 0, 0}}, 2, "ab"};
  CHECK(hex(encode_message(route)) ==
        "00010000"  // encapsulation
        "01000000"
        "00000000"  // one point, padding to 8
        "000000000000f03f"
        "0000000000000000"
        "0000000000000000"
        "0000000000000040"  // length_m
        "03000000"
        "616200");  // remark
}

TEST_CASE("a value behind others is aligned as if it had been written with them") {
  Bytes message = encode_message(std::uint8_t{7});
  const auto& support = skein::idl::type_support<test_geometry::Position>();
  const test_geometry::Position position{1, 2, 3};
  support.encode(&position, message);
  CHECK(message.size() == 4 + 8 + 24);
  test_geometry::Position back;
  CHECK(support.decode(&back, message, 5) == message.size());
  CHECK(back == position);
}

TEST_CASE("encoding fills whatever room the message has, and grows it where there is none") {
  test_planner::Problem problem;
  for (const std::size_t size : {0u, 1u, 400u, 500u, 512u, 1000u, 100000u}) {
    problem.terrain.assign(size, 9);
    for (const std::size_t room : {0u, 4u, 60u, 511u, 600u}) {
      Bytes message;
      message.reserve(room);
      message.append(skein::idl::kEncapsulation);
      skein::idl::type_support<test_planner::Problem>().encode(&problem, message);
      CHECK(decode_message<test_planner::Problem>(message) == problem);
    }
  }
}

TEST_CASE("both byte orders are read") {
  const auto big = message_of({0, 0, 0, 0, 0x12, 0x34, 0x56, 0x78});
  CHECK(decode_message<std::uint32_t>(big) == 0x12345678);
  const auto little = message_of({0, 1, 0, 0, 0x78, 0x56, 0x34, 0x12});
  CHECK(decode_message<std::uint32_t>(little) == 0x12345678);

  Bytes route{std::span<const std::byte>(skein::idl::kEncapsulation)};
  const test_planner::Route value{{{1, 2, 3}}, 4, "five"};
  skein::idl::append_cdr(
      route, [&](CdrWriter& writer) { skein::idl::encode(writer, value); }, ByteOrder::Big);
  route.data()[1] = std::byte{0};
  CHECK(decode_message<test_planner::Route>(route) == value);
}

TEST_CASE("a refusal names type, member and offset") {
  Bytes message = encode_message(test_planner::Route{{}, 2, "ab"});
  message.resize(message.size() - 1);
  CHECK(refusal<test_planner::Route>(message) ==
        "malformed sample: test_planner::Route.remark at offset 24: a length of 3 does not fit "
        "into the 2 "
        "bytes that are left");
  CHECK(refusal<everything::Colour>(message_of({0, 1, 0, 0, 3, 0, 0, 0})) ==
        "malformed sample: message at offset 8: 3 is no value of the enumeration");
  CHECK(refusal<bool>(message_of({0, 1, 0, 0, 2})) ==
        "malformed sample: message at offset 5: 2 is no boolean");
  CHECK(refusal<std::string>(message_of({0, 1, 0, 0, 2, 0, 0, 0, 'a', 'b'})) ==
        "malformed sample: message at offset 10: a string is not terminated");
  CHECK(refusal<std::string>(message_of({0, 1, 0, 0, 3, 0, 0, 0, 'a', 0, 0})) ==
        "malformed sample: message at offset 11: a string holds a zero byte");
  CHECK(refusal<double>(message_of({0, 1, 0, 0, 1, 2, 3})) ==
        "malformed sample: message at offset 4: the message ends here");
}

TEST_CASE("other representations than PLAIN_CDR are refused with the remedy") {
  CHECK(refusal<bool>(message_of({0, 3, 0, 0, 1})) ==
        "malformed sample: representation 3 is not PLAIN_CDR (0 or 1); the writer must be set to "
        "XCDR1");
  CHECK(refusal<extensible::Part>(message_of({0, 1, 0, 0, 1})) ==
        "malformed sample: representation 1 is not XCDR2 (6 to 11); the writer must be set to "
        "XCDR2");
  CHECK(refusal<bool>(message_of({0, 1})) ==
        "malformed sample: 2 bytes cannot hold a value at offset 4");
}

TEST_CASE("a bound is kept on decoding") {
  // Compound.tags: read through a type of the same layout that has no bound.
  everything::Shape shape;
  shape.remark("abcdef");
  Bytes message = encode_message(shape);
  message = encode_message(std::array<std::uint32_t, 1>{2});
  skein::idl::append_cdr(message, [](CdrWriter& writer) { writer.write_string("abcdefg"); });
  CHECK(refusal<everything::Shape>(message) ==
        "malformed sample: everything::Shape.remark holds 7 elements, at most 6 are allowed");
}

TEST_CASE("a value takes no more than some times the memory of its message") {
  // Each element is a byte that says that the optional member is absent.
  Bytes message{std::span<const std::byte>(encapsulation(skein::Representation::Xcdr2Plain))};
  skein::idl::append_cdr(message, [](CdrWriter& writer) {
    writer.write(std::uint32_t{60'000 + 4});
    writer.write(std::uint32_t{60'000});
    for (int i = 0; i < 60'000; ++i) writer.write(std::uint8_t{0});
  });
  const AllocationMeter meter;
  CHECK_THROWS_WITH(decode_message<extensible::Crowd>(message),
                    Catch::Contains("more than 1024 times the memory of its message"));
  CHECK(meter.allocated() < 400u << 20);
}

TEST_CASE("a length of four gigabytes is refused before anything is allocated") {
  const auto claim = message_of({0, 1, 0, 0, 0xFF, 0xFF, 0xFF, 0xFF, 0, 0, 0, 0});
  const AllocationMeter meter;
  CHECK_THROWS_AS(decode_message<std::string>(claim), MalformedSample);
  CHECK_THROWS_AS(decode_message<std::vector<std::uint8_t>>(claim), MalformedSample);
  CHECK_THROWS_AS(decode_message<std::vector<double>>(claim), MalformedSample);
  CHECK_THROWS_AS(decode_message<std::vector<bool>>(claim), MalformedSample);
  CHECK_THROWS_AS(decode_message<std::vector<everything::Compound>>(claim), MalformedSample);
  CHECK_THROWS_AS(decode_message<recursive::Tree>(claim), MalformedSample);
  CHECK(meter.allocated() < 16384);
}

TEST_CASE("a message that nests a recursive type too deep is refused") {
  Bytes message{std::span<const std::byte>(skein::idl::kEncapsulation)};
  skein::idl::append_cdr(message, [](CdrWriter& writer) {
    for (int i = 0; i < 100000; ++i) {
      writer.write_string("abc");
      writer.write_length(1);
    }
  });
  CHECK(
      refusal<recursive::Tree>(message).ends_with("the value is nested more than 100 levels deep"));
}

TEST_CASE("every truncation of a message is refused or harmless, and cheap") {
  for (const Specimen& specimen : specimens()) {
    const std::span<const std::byte> whole = specimen.message;
    for (std::size_t size = 0; size < whole.size(); ++size) {
      // A buffer of its own, so that a sanitizer sees what is read beyond the end.
      const Bytes cut(whole.first(size));
      if (decode_hostile(specimen, cut) > allowance(size))
        FAIL("cut at " << size << " of " << specimen.support->name);
    }
  }
}

TEST_CASE("thousands of mutations of a message are refused or harmless, and cheap") {
  std::mt19937 random(20240607);
  for (const Specimen& specimen : specimens()) {
    for (int round = 0; round < 4000; ++round) {
      Bytes mutant{std::span<const std::byte>(specimen.message)};
      for (unsigned n = 1 + random() % 4; n > 0; --n) {
        const std::size_t at = 4 + random() % (mutant.size() - 4);
        mutant.data()[at] = random() % 3 ? std::byte(random()) : std::byte{0xFF};
      }
      if (decode_hostile(specimen, mutant) > allowance(mutant.size())) {
        FAIL("round " << round << " of " << specimen.support->name);
      }
    }
  }
}

TEST_CASE("what decodes from a mutated message encodes to a message of the same value") {
  std::mt19937 random(7);
  int accepted = 0;
  const Bytes valid = encode_message(samples::compound());
  for (int round = 0; round < 2000; ++round) {
    Bytes mutant{std::span<const std::byte>(valid)};
    mutant.data()[4 + random() % (mutant.size() - 4)] = std::byte(random());
    everything::Compound value;
    try {
      value = decode_message<everything::Compound>(mutant);
    } catch (const MalformedSample&) {
      continue;
    }
    ++accepted;
    const Bytes once = encode_message(value);
    CHECK(hex(encode_message(decode_message<everything::Compound>(once))) == hex(once));
  }
  CHECK(accepted > 100);
}
