// Our CDR against that of C types which idlc makes from the flattened IDL.
#include <dds/dds.h>
#include <dds/ddsi/ddsi_cdrstream.h>
#include <dds/ddsi/q_protocol.h>

#include <catch2/catch.hpp>
#include <cstring>

#include "everything.dds.h"
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
      : descriptor_(descriptor), body_(message.data() + 4, message.data() + message.size()) {
    const auto size = static_cast<std::uint32_t>(body_.size());
    std::uint32_t end = 0;
    accepted_ = dds_stream_normalize_data(reinterpret_cast<char*>(body_.data()), &end, size, false,
                                          CDR_ENC_VERSION_1, descriptor.m_ops) &&
                end == size;
    if (!accepted_) return;
    dds_istream_t stream;
    dds_istream_init(&stream, size, body_.data(), CDR_ENC_VERSION_1);
    dds_stream_read(&stream, reinterpret_cast<char*>(&value_), descriptor.m_ops);
  }
  ~Decoded() { dds_stream_free_sample(&value_, descriptor_.m_ops); }
  Decoded(const Decoded&) = delete;
  Decoded& operator=(const Decoded&) = delete;

  bool accepted() const { return accepted_; }
  const T* operator->() const { return &value_; }

  /// Whether Cyclone DDS writes the value with the very bytes that it was read from.
  bool writes_the_same() const {
    dds_ostream_t stream;
    dds_ostream_init(&stream, 0, CDR_ENC_VERSION_1);
    dds_stream_write(&stream, reinterpret_cast<const char*>(&value_), descriptor_.m_ops);
    const bool same = stream.m_index == body_.size() &&
                      std::memcmp(stream.m_buffer, body_.data(), body_.size()) == 0;
    dds_ostream_fini(&stream);
    return same;
  }

 private:
  const dds_topic_descriptor_t& descriptor_;
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
Bytes request(const skein::OperationInfo& operation, const void* in) {
  Bytes message{std::span<const std::byte>(skein::idl::kEncapsulation)};
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
            const skein::TypeSupport& type, const void* value) {
  Bytes message{std::span<const std::byte>(skein::idl::kEncapsulation)};
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
