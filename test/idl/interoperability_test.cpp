// Our CDR against that of C types which idlc makes from the flattened IDL.
#include <dds/dds.h>
#include <dds/ddsi/ddsi_cdrstream.h>
#include <dds/ddsi/q_protocol.h>

#include <catch2/catch.hpp>
#include <cstring>

#include "everything.dds.h"
#include "extensible.dds.h"
#include "modern.dds.h"
#include "planner.dds.h"
#include "planner.idl.hpp"
#include "samples.hpp"
#include "skein/detail/codec.hpp"
#include "skein/detail/type_support.hpp"

using skein::Bytes;
using skein::idl::CdrWriter;
using skein::idl::encode_message;

namespace {

/// A message, decoded by Cyclone DDS into the C type `T` of `descriptor`.
template <class T>
class Decoded {
 public:
  Decoded(const Bytes& message, const dds_topic_descriptor_t& descriptor)
      : descriptor_(descriptor),
        version_(message.data()[1] == std::byte{1} ? CDR_ENC_VERSION_1 : CDR_ENC_VERSION_2),
        body_(message.data() + 4, message.data() + message.size()) {
    const auto size = static_cast<std::uint32_t>(body_.size());
    std::uint32_t end = 0;
    accepted_ = dds_stream_normalize_data(reinterpret_cast<char*>(body_.data()), &end, size, false,
                                          version_, descriptor.m_ops) &&
                end == size;
    if (!accepted_) return;
    dds_istream_t stream;
    dds_istream_init(&stream, size, body_.data(), version_);
    dds_stream_read(&stream, reinterpret_cast<char*>(&value_), descriptor.m_ops);
  }
  ~Decoded() { dds_stream_free_sample(&value_, descriptor_.m_ops); }
  Decoded(const Decoded&) = delete;
  Decoded& operator=(const Decoded&) = delete;

  bool accepted() const { return accepted_; }
  const T* operator->() const { return &value_; }

  /// Whether Cyclone DDS writes the value with the very bytes that it was read from.
  bool writes_the_same() const { return written() == body_; }

  /// What Cyclone DDS writes of the value, without an encapsulation header.
  std::vector<std::byte> written() const {
    dds_ostream_t stream;
    dds_ostream_init(&stream, 0, version_);
    dds_stream_write(&stream, reinterpret_cast<const char*>(&value_), descriptor_.m_ops);
    const auto* first = reinterpret_cast<const std::byte*>(stream.m_buffer);
    std::vector<std::byte> bytes(first, first + stream.m_index);
    dds_ostream_fini(&stream);
    return bytes;
  }

 private:
  const dds_topic_descriptor_t& descriptor_;
  std::uint32_t version_;
  std::vector<std::byte> body_;
  bool accepted_ = false;
  T value_{};
};

#define CHECK_SAME(ctype, value)                                       \
  do {                                                                 \
    const Decoded<ctype> decoded(encode_message(value), ctype##_desc); \
    INFO(#ctype);                                                      \
    REQUIRE(decoded.accepted());                                       \
    CHECK(decoded.writes_the_same());                                  \
  } while (false)

const skein::OperationInfo& operation(const skein::InterfaceInfo& info, std::string_view name) {
  for (const auto& one : info.operations) {
    if (one.name == name) return one;
  }
  throw std::runtime_error("no such operation");
}

/// The header of DDS-RPC's basic mapping, and what follows it up to the parameters.
Bytes request(const skein::OperationInfo& operation, const void* in,
              skein::Representation representation = skein::Representation::Xcdr1) {
  Bytes message{std::span<const std::byte>(skein::encapsulation(representation))};
  skein::idl::append_cdr(message, [&](CdrWriter& writer) {
    writer.write_array(skein::Guid::from_hex("000102030405060708090a0b0c0d0e0f")->bytes.data(), 16);
    writer.write(std::int32_t{1});
    writer.write(std::uint32_t{2});
    writer.write_string("main");
    writer.write(static_cast<std::int32_t>(operation.hash));
  });
  operation.in->encode(in, message);
  return message;
}

Bytes reply(const skein::OperationInfo& operation, std::int32_t result,
            const skein::TypeSupport& type, const void* value,
            skein::Representation representation = skein::Representation::Xcdr1) {
  Bytes message{std::span<const std::byte>(skein::encapsulation(representation))};
  skein::idl::append_cdr(message, [&](CdrWriter& writer) {
    writer.write_array(skein::Guid{}.bytes.data(), 16);
    writer.write(std::int32_t{0});
    writer.write(std::uint32_t{7});
    writer.write(std::int32_t{0});
    writer.write(static_cast<std::int32_t>(operation.hash));
    writer.write(result);
  });
  type.encode(value, message);
  return message;
}

}  // namespace

TEST_CASE("Cyclone DDS reads and writes our bytes for every kind of type") {
  CHECK_SAME(everything_Basic, samples::basic());
  CHECK_SAME(everything_Compound, samples::compound());
  CHECK_SAME(everything_Compound, everything::Compound());
  CHECK_SAME(everything_Choices, samples::choices());
  everything::Choices letters;
  letters.letter.flag(true);
  letters.shapes.emplace_back();
  CHECK_SAME(everything_Choices, letters);
  everything::Number number;
  number.raw({1, 2, 3});
  CHECK_SAME(everything_Number, number);
  everything::Maybe maybe;
  maybe.select(false);
  CHECK_SAME(everything_Maybe, maybe);
  const test_planner::Problem problem{{1, 2, 3}, {4, 5, 6}, test_planner::Speed::Fast, {1, 2}};
  CHECK_SAME(test_planner_Problem, problem);
  CHECK_SAME(test_planner_IPlanner_plan_In, test_planner::IPlanner_plan_In{problem});
  CHECK_SAME(test_planner_NoRoute, test_planner::NoRoute("fog", 7));
  CHECK_SAME(test_planner_Busy, test_planner::Busy());
  CHECK_SAME(test_planner_IPlanner_reset_In, test_planner::IPlanner_reset_In());
  const skein::Reference<test_planner::IObserver> reference({"A/I", skein::Guid::random(), "x"});
  CHECK_SAME(test_planner_IPlanner_observe_In, test_planner::IPlanner_observe_In{reference});
}

TEST_CASE("Cyclone DDS finds in our bytes the values that we wrote") {
  const Decoded<everything_Basic> basic(encode_message(samples::basic()), everything_Basic_desc);
  REQUIRE(basic.accepted());
  CHECK(basic->flag);
  CHECK(basic->letter == 'x');
  CHECK(basic->byte == 200);
  CHECK(basic->small == -300);
  CHECK(basic->small_unsigned == 60000);
  CHECK(basic->medium == -70000);
  CHECK(basic->medium_unsigned == 4000000000U);
  CHECK(basic->large == -5000000000LL);
  CHECK(basic->large_unsigned == 18000000000000000000ULL);
  CHECK(basic->single == 1.5F);
  CHECK(basic->real == -2.25);
  CHECK(basic->text == std::string("text"));
  CHECK(basic->colour == everything_Blue);
}

TEST_CASE("a request is the flattened IDL's request type") {
  using test_planner::IPlanner;
  const test_planner::IPlanner_plan_In in{test_planner::Problem{{1, 2, 3}, {4, 5, 6}, {}, {9}}};
  const auto message = request(operation(IPlanner::interface_info(), "plan"), &in);
  const Decoded<test_planner_IPlanner_Request> decoded(message, test_planner_IPlanner_Request_desc);
  REQUIRE(decoded.accepted());
  CHECK(decoded->header.requestId.writer_guid.guidPrefix[3] == 3);
  CHECK(decoded->header.requestId.writer_guid.entityId.entityKind == 15);
  CHECK(decoded->header.requestId.sequence_number.high == 1);
  CHECK(decoded->header.requestId.sequence_number.low == 2);
  CHECK(decoded->header.instanceName == std::string("main"));
  REQUIRE(decoded->data._d == test_planner_IPlanner_plan_Hash);
  CHECK(decoded->data._u.plan.problem.goal.up_m == 6);
  CHECK(decoded->data._u.plan.problem.terrain._length == 1);
}

TEST_CASE("requests and replies with types that grow are XCDR2, as those of the flattened IDL") {
  using namespace extensible;
  const auto& interface = Garden::interface_info();
  const auto xcdr2 = interface.representation();
  CHECK(xcdr2 == skein::Representation::Xcdr2Plain);
  const auto& grow = operation(interface, "grow");
  const Garden_grow_In in{samples::part(), std::vector{samples::part_later()}, samples::choice()};
  const Decoded<extensible_Garden_Request> asked(request(grow, &in, xcdr2),
                                                 extensible_Garden_Request_desc);
  REQUIRE(asked.accepted());
  CHECK(asked.writes_the_same());
  REQUIRE(asked->data._d == extensible_Garden_grow_Hash);
  CHECK(asked->data._u.grow.part.value == samples::part().value);

  const auto& plain = operation(interface, "plain");
  const Garden_plain_In number{1.5};
  const Decoded<extensible_Garden_Request> second(request(plain, &number, xcdr2),
                                                  extensible_Garden_Request_desc);
  REQUIRE(second.accepted());
  CHECK(second.writes_the_same());

  const Garden_grow_Out out{samples::part(), samples::choice()};
  const Decoded<extensible_Garden_Reply> grown(reply(grow, 0, *grow.out, &out, xcdr2),
                                               extensible_Garden_Reply_desc);
  REQUIRE(grown.accepted());
  CHECK(grown.writes_the_same());
  const Stunted stunted(samples::part());
  const auto hash = static_cast<std::int32_t>(stunted.info().hash);
  const Decoded<extensible_Garden_Reply> failed(
      reply(grow, hash, *stunted.info().type, &stunted, xcdr2), extensible_Garden_Reply_desc);
  REQUIRE(failed.accepted());
  CHECK(failed.writes_the_same());
}

TEST_CASE("a reply and an exception are the flattened IDL's reply type") {
  using test_planner::IPlanner;
  const auto& plan = operation(IPlanner::interface_info(), "plan");
  const test_planner::IPlanner_plan_Out out{test_planner::Route{{{1, 2, 3}}, 12.5, "fine"}};
  const Decoded<test_planner_IPlanner_Reply> success(reply(plan, 0, *plan.out, &out),
                                                     test_planner_IPlanner_Reply_desc);
  REQUIRE(success.accepted());
  CHECK(success->header.relatedRequestId.sequence_number.low == 7);
  REQUIRE(success->data._d == test_planner_IPlanner_plan_Hash);
  REQUIRE(success->data._u.plan._d == 0);
  CHECK(success->data._u.plan._u.result.return_.length_m == 12.5);

  const test_planner::NoRoute fog("fog", 7);
  const auto& info = fog.info();
  const Decoded<test_planner_IPlanner_Reply> failure(
      reply(plan, static_cast<std::int32_t>(info.hash), *info.type, fog.value()),
      test_planner_IPlanner_Reply_desc);
  REQUIRE(failure.accepted());
  CHECK(failure->data._u.plan._u.noRoute_ex.reason == std::string("fog"));
  CHECK(failure->data._u.plan._u.noRoute_ex.explored == 7);
}

TEST_CASE("types of IDL 4 are what the flattened IDL says") {
  CHECK_SAME(modern_Leaf, samples::leaf());
  CHECK_SAME(modern_Maps, samples::maps());
  CHECK_SAME(modern_WideText, samples::wide_text());
  CHECK_SAME(modern_Bits, samples::bits());
  modern::ByLetter letter;
  CHECK_SAME(modern_ByLetter, letter);
  letter.text(samples::wide_text());
  CHECK_SAME(modern_ByLetter, letter);
  modern::ByNumber number;
  number.pairs({{1, 2}, {3, 4}});
  CHECK_SAME(modern_ByNumber, number);
  modern::ByLevel level;
  level.x(-5);  // Cyclone DDS 0.10 finds no case of a 16-bit label below zero.
  CHECK_SAME(modern_ByLevel, level);
}

TEST_CASE("the values of IDL 4's types arrive in the types of the flattened IDL") {
  const Decoded<modern_Bits> bits(encode_message(samples::bits()), modern_Bits_desc);
  REQUIRE(bits.accepted());
  CHECK(bits->flags == 0x09);
  CHECK(bits->wide == 0x8000000000);
  // kind 5, valid, 4 free, angle -300 in 10 bits, number 0xABCDE.
  CHECK(bits->packet == (5U | 1U << 3 | (0x3FFULL & -300) << 8 | 0xABCDEULL << 18));

  const Decoded<modern_WideText> text(encode_message(samples::wide_text()), modern_WideText_desc);
  REQUIRE(text.accepted());
  CHECK(text->letter == 0x20AC);
  // U+20AC and U+1D11E, in UTF-16.
  CHECK(text->text._length == 6);
  CHECK(std::memcmp(text->text._buffer, "\xAC\x20\x34\xD8\x1E\xDD", 6) == 0);

  const Decoded<modern_Leaf> leaf(encode_message(samples::leaf()), modern_Leaf_desc);
  REQUIRE(leaf.accepted());
  CHECK(leaf->id == -8);
  CHECK(leaf->level == -3);
  CHECK(leaf->phases[1][0] == 20);
}

TEST_CASE("XCDR2 of final and appendable types is what Cyclone DDS makes of it") {
  CHECK_SAME(extensible_Whole, samples::whole());
  CHECK_SAME(extensible_Whole, extensible::Whole{});
  CHECK_SAME(extensible_Part, samples::part());
  CHECK_SAME(extensible_PartLater, samples::part_later());
  extensible::Choice choice(samples::choice());
  CHECK_SAME(extensible_Choice, choice);
  choice.value(0.5);
  CHECK_SAME(extensible_Choice, choice);
  CHECK_SAME(extensible_Leaf, samples::extended_leaf());
}

TEST_CASE("mutable types go to Cyclone DDS and come back") {
  const auto comes_back = [](const auto& value, const auto& decoded) {
    REQUIRE(decoded.accepted());
    Bytes message{
        std::span<const std::byte>(encapsulation(skein::Representation::Xcdr2ParameterList))};
    message.append(decoded.written());
    using Value = std::remove_cvref_t<decltype(value)>;
    CHECK(skein::idl::decode_message<Value>(message) == value);
  };
  for (const auto& report : {samples::report(), extensible::Report{}}) {
    comes_back(report, Decoded<extensible_Report>(encode_message(report), extensible_Report_desc));
  }
  const extensible::Hashed hashed{5, -6};
  comes_back(hashed, Decoded<extensible_Hashed>(encode_message(hashed), extensible_Hashed_desc));
}

TEST_CASE("Cyclone DDS reads an older version of what we write, and we of what it writes") {
  const Decoded<extensible_Part> older(encode_message(samples::part_later()), extensible_Part_desc);
  REQUIRE(older.accepted());
  CHECK(older->value == samples::part_later().value);
  const Decoded<extensible_PartLater> later(encode_message(samples::part()),
                                            extensible_PartLater_desc);
  REQUIRE(later.accepted());
  CHECK(later->added == 0);
  const Decoded<extensible_Report> fewer(encode_message(samples::report_later()),
                                         extensible_Report_desc);
  REQUIRE(fewer.accepted());
  CHECK(fewer->number == samples::report_later().number);
}
