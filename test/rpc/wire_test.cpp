#include "rpc/wire/wire.hpp"

#include <catch2/catch.hpp>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

using namespace skein;
using namespace skein::rpc;
using namespace std::chrono_literals;

namespace {

const wire::RequestId kId{*Guid::from_hex("000102030405060708090a0b0c0d0e0f"), 0x1'0000'0007};

Bytes a_request() {
  Bytes message;
  wire::begin_request(message, kId, wire::kOpen);
  wire::append_default_branch(message);
  wire::append_trailer(
      message, wire::RequestTrailer{1500ms, 42, {Guid::random(), Guid::random()}, "declared"});
  return message;
}

std::string hex(const Bytes& message, std::size_t first, std::size_t count) {
  std::string text;
  for (std::size_t i = first; i < first + count; ++i) {
    constexpr char kDigits[] = "0123456789abcdef";
    text += kDigits[std::to_integer<int>(message.data()[i]) >> 4];
    text += kDigits[std::to_integer<int>(message.data()[i]) & 15];
  }
  return text;
}

}  // namespace

TEST_CASE("a request begins as DDS-RPC's basic mapping says") {
  const Bytes message = a_request();
  CHECK(hex(message, 0, 4) == "00010000");                           // PLAIN_CDR, little-endian
  CHECK(hex(message, 4, 16) == "000102030405060708090a0b0c0d0e0f");  // writer GUID
  CHECK(hex(message, 20, 8) == "0100000007000000");                  // sequence number: high, low
  CHECK(hex(message, 28, 8) == "0100000000000000");                  // instance name "", padding
  CHECK(hex(message, 36, 4) == "6f70656e");                          // discriminator
}

TEST_CASE("a request's head and trailer are read as they were written") {
  const Bytes message = a_request();
  const auto head = wire::read_request_head(message);
  CHECK(head.id == kId);
  CHECK(head.instance.empty());
  CHECK(head.operation == wire::kOpen);
  const auto trailer = wire::read_request_trailer(message, head.body + 1);
  REQUIRE(trailer);
  CHECK(trailer->remaining == 1500ms);
  CHECK(trailer->target == 42);
  CHECK(trailer->chain.size() == 2);
  CHECK(trailer->strategy == "declared");
}

TEST_CASE("the time that a caller leaves is read as a year at most, and never as less than none") {
  const auto read = [](Duration left) {
    Bytes message;
    wire::begin_request(message, kId, wire::kOpen);
    wire::append_default_branch(message);
    wire::append_trailer(message, wire::RequestTrailer{left});
    const auto head = wire::read_request_head(message);
    return wire::read_request_trailer(message, head.body + 1)->remaining;
  };
  CHECK(read(Duration::max()) == 24h * 365);
  CHECK(read(Duration::min()) == 0s);
}

TEST_CASE("a reply's head and trailer are read as they were written") {
  Bytes message;
  wire::begin_reply(message, kId, wire::RemoteException::OutOfResources, 0);
  wire::append_default_branch(message);
  wire::append_trailer(message, wire::ReplyTrailer{ErrorCode::Overloaded, "full"});
  const auto head = wire::read_reply_head(message);
  CHECK(head.related == kId);
  CHECK(head.exception == wire::RemoteException::OutOfResources);
  const auto trailer = wire::read_reply_trailer(message, head.result + 1);
  REQUIRE(trailer);
  CHECK(trailer->code == ErrorCode::Overloaded);
  CHECK(trailer->text == "full");
}

TEST_CASE("what came later stands at a trailer's end, and older peers do not write it") {
  Bytes message;
  wire::begin_request(message, kId, wire::kCredit);
  wire::append_default_branch(message);
  const std::size_t end = message.size();
  wire::append_trailer(message, wire::RequestTrailer{1s, 42, {}, "", 8, 90h});
  CHECK(wire::read_request_trailer(message, end)->credit == 8);
  CHECK(wire::read_request_trailer(message, end)->sent == 90h);
  const auto shorten = [&](std::size_t at, std::uint32_t by) {
    std::uint32_t length;
    std::memcpy(&length, message.data() + at, 4);
    length -= by;
    std::memcpy(message.data() + at, &length, 4);
  };
  message.resize(message.size() - 8);
  shorten(48, 8);
  CHECK(wire::read_request_trailer(message, end)->credit == 8);
  CHECK(wire::read_request_trailer(message, end)->sent == 0h);
  message.resize(message.size() - 4);
  shorten(48, 4);
  CHECK(wire::read_request_trailer(message, end)->credit == 0);

  wire::begin_reply(message, kId, wire::RemoteException::Ok, 7);
  wire::append_discriminator(message, 0);
  const std::size_t result = message.size();
  wire::append_trailer(message, wire::ReplyTrailer{{}, {}, wire::StreamPart::Item, 5});
  CHECK(wire::read_reply_trailer(message, result)->part == wire::StreamPart::Item);
  CHECK(wire::read_reply_trailer(message, result)->position == 5);
  message.resize(message.size() - 12);
  shorten(result + 4, 12);
  CHECK(wire::read_reply_trailer(message, result)->part == wire::StreamPart::None);
}

TEST_CASE("what a later version appends to a trailer is passed over, whatever its numbers are") {
  constexpr auto kMost = std::numeric_limits<std::uint64_t>::max();
  Bytes message;
  std::size_t end = 0;
  const auto append_later_fields = [&] {
    message.append(std::vector<std::byte>(20, std::byte{0xff}));
    const auto length = static_cast<std::uint32_t>(message.size() - end - 8);
    std::memcpy(message.data() + end + 4, &length, 4);
  };
  wire::begin_request(message, {kId.client, kMost}, std::uint32_t{0xffffffff});
  end = message.size();
  wire::append_trailer(
      message, wire::RequestTrailer{Duration::max(), kMost, {}, "", 0xffffffff, Duration::min()});
  append_later_fields();
  CHECK(wire::read_request_id(message)->number == kMost);
  CHECK(wire::ends_with_trailer(message));
  const auto request = wire::read_request_trailer(message, end);
  REQUIRE(request);
  CHECK(request->remaining == 24h * 365);
  CHECK(request->target == kMost);
  CHECK(request->credit == 0xffffffff);
  CHECK(request->sent == 0h);

  wire::begin_reply(message, kId, wire::RemoteException{4711}, 7);
  end = message.size();
  wire::append_trailer(message, wire::ReplyTrailer{ErrorCode{4711}, "later", {}, kMost});
  append_later_fields();
  const auto reply = wire::read_reply_trailer(message, end);
  REQUIRE(reply);
  CHECK(reply->text == "later");
  CHECK(reply->position == kMost);
  CHECK(wire::error_code_of(wire::read_reply_head(message).exception) == ErrorCode::Internal);
}

TEST_CASE("a message without a trailer comes from a peer that is not built with Skein") {
  Bytes message;
  wire::begin_request(message, kId, 7);
  wire::append_default_branch(message);
  CHECK_FALSE(wire::read_request_trailer(message, message.size()));
}

TEST_CASE("a big-endian request is understood") {
  std::vector<std::uint8_t> bytes{0, 0, 0, 0};
  for (std::uint8_t i = 0; i < 16; ++i) bytes.push_back(i);
  for (const std::uint8_t byte :
       {0, 0, 0, 1, 0, 0, 0, 7, 0, 0, 0, 1, 0, 0, 0, 0, 0x12, 0x34, 0x56, 0x78}) {
    bytes.push_back(byte);
  }
  const auto head = wire::read_request_head(std::as_bytes(std::span(bytes)));
  CHECK(head.id == kId);
  CHECK(head.operation == 0x12345678);
}

TEST_CASE("no truncation and no mutation of a message does more than throw InvalidArgument") {
  const Bytes whole = a_request();
  const auto read = [](std::span<const std::byte> message) {
    try {
      const auto head = wire::read_request_head(message);
      wire::read_request_trailer(message, std::min(head.body + 1, message.size()));
    } catch (const InvalidArgument&) {
      return false;
    }
    return true;
  };
  REQUIRE(read(whole));
  for (std::size_t size = 0; size < wire::read_request_head(whole).body; ++size) {
    CAPTURE(size);
    CHECK_FALSE(read(std::span<const std::byte>(whole).first(size)));
  }
  std::mt19937 random(1);
  for (int round = 0; round < 20'000; ++round) {
    Bytes mutated{std::span<const std::byte>(whole)};
    for (int change = 0; change < 4; ++change) {
      mutated.data()[random() % mutated.size()] = static_cast<std::byte>(random());
    }
    mutated.resize(1 + random() % mutated.size());
    read(mutated);
  }
}

TEST_CASE("a length of 4 GB is refused before anything is allocated") {
  Bytes message = a_request();
  const std::uint32_t huge = 0xFFFFFFFF;
  std::memcpy(message.data() + 28, &huge, 4);
  CHECK_THROWS_AS(wire::read_request_head(message), InvalidArgument);
}

TEST_CASE("whether a trailer ends a message is seen without knowing its body") {
  Bytes message = a_request();
  CHECK(wire::ends_with_trailer(message));
  for (int padding = 0; padding < 3; ++padding) {
    message.append(std::as_bytes(std::span("")));
    CHECK(wire::ends_with_trailer(message));
  }
  Bytes none;
  for (int size = 0; size < 200; ++size) {
    CHECK_FALSE(wire::ends_with_trailer(none));
    none.append(std::as_bytes(std::span("")));
  }
  message = a_request();
  for (std::size_t size = 0; size < message.size(); ++size) {
    CHECK_FALSE(wire::ends_with_trailer(std::span<const std::byte>(message).first(size)));
  }
}

TEST_CASE("a message's identity is read where the rest of its head is damaged") {
  const Bytes message = a_request();
  const std::span<const std::byte> bytes = message;
  for (std::size_t size = 0; size < 28; ++size)
    CHECK_FALSE(wire::read_request_id(bytes.first(size)));
  CHECK(wire::read_request_id(bytes.first(28)) == kId);
}
