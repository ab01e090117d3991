#include "view/client_messages.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "skein/error.hpp"
#include "test/tools/seed.hpp"

using namespace skein::view;
using Catch::Contains;

namespace {

std::string call(std::string_view encoding, std::string_view request) {
  std::string bytes("\x02\x01\x00\x00\x00\xff\xff\xff\xff", 9);
  bytes += static_cast<char>(encoding.size());
  bytes.append(3, '\0');
  bytes += encoding;
  bytes += request;
  return bytes;
}

/// Whether it is a message; what is none must be refused as InvalidArgument, and nothing else.
template <class Decode>
bool is_message(const Decode& decode, const std::string& bytes) {
  try {
    decode(bytes);
    return true;
  } catch (const skein::InvalidArgument&) {
    return false;
  }
}

using Random = std::mt19937_64;

std::string random_bytes(Random& random) {
  std::string bytes(random() % 64, '\0');
  for (char& byte : bytes) byte = static_cast<char>(random());
  return bytes;
}

void mutate(Random& random, std::string& bytes) {
  for (auto changes = 1 + random() % 4; changes > 0 && !bytes.empty(); --changes) {
    const std::size_t at = random() % bytes.size();
    switch (random() % 4) {
      case 0:
        bytes[at] = static_cast<char>(random());
        break;
      case 1:
        bytes.erase(at, random() % 8);
        break;
      case 2:
        bytes.insert(at, bytes.substr(random() % bytes.size(), random() % 16));
        break;
      default:
        bytes.insert(at, random_bytes(random));
    }
  }
}

}  // namespace

TEST_CASE("Subscriptions name a channel each") {
  const auto message = std::get<Subscribe>(decode_text(
      R"({"op":"subscribe","subscriptions":[{"id":0,"channelId":3},{"id":4294967295,"channelId":5}]})"));
  REQUIRE(message.subscriptions.size() == 2);
  CHECK(message.subscriptions[0].id == 0);
  CHECK(message.subscriptions[0].channel == 3);
  CHECK(message.subscriptions[1].id == 4294967295);
}

TEST_CASE("Subscriptions are ended by their numbers") {
  const auto message =
      std::get<Unsubscribe>(decode_text(R"({"op":"unsubscribe","subscriptionIds":[0,7]})"));
  CHECK(message.subscriptions == std::vector<std::uint32_t>{0, 7});
}

TEST_CASE("Members that a later version may add are passed over") {
  CHECK(std::holds_alternative<SubscribeGraph>(
      decode_text(R"({"op":"subscribeConnectionGraph","since":[{}]})")));
  CHECK(std::holds_alternative<UnsubscribeGraph>(
      decode_text(R"({"op":"unsubscribeConnectionGraph"})")));
}

TEST_CASE("A call consists of its service, its number, its encoding and its request") {
  const auto message = std::get<CallService>(decode_binary(call("json", "{}")));
  CHECK(message.service == 1);
  CHECK(message.call == 4294967295);
  CHECK(message.encoding == "json");
  CHECK(message.request == "{}");
}

TEST_CASE("What is wrong with a message is told with its place") {
  CHECK_THROWS_WITH(decode_text(""), Contains("no JSON"));
  CHECK_THROWS_WITH(decode_text("[]"), Contains("'op'"));
  CHECK_THROWS_WITH(decode_text(R"({"op":"subscripe"})"),
                    Contains("'subscripe' is not offered") && Contains("'subscribe'?"));
  CHECK_THROWS_WITH(decode_text(R"({"op":"subscribe","subscriptions":[{"id":-1,"channelId":3}]})"),
                    Contains("$.subscriptions[0].id is out of range"));
  CHECK_THROWS_WITH(decode_binary(""), Contains("1 bytes too early"));
  CHECK_THROWS_WITH(decode_binary("\x07"), Contains("operation 7"));
  CHECK_THROWS_WITH(decode_binary(call("json", "").substr(0, 14)), Contains("3 bytes too early"));
}

TEST_CASE("However deep a message is nested, it is refused") {
  const std::string open(500'000, '[');
  CHECK_FALSE(is_message(decode_text, open));
  CHECK_FALSE(is_message(decode_text, open + std::string(open.size(), ']')));
}

TEST_CASE("No bytes make the decoders crash, or throw anything but InvalidArgument") {
  const std::vector<std::string> texts{
      R"({"op":"subscribe","subscriptions":[{"id":0,"channelId":3},{"id":1,"channelId":5}]})",
      R"({"op":"unsubscribe","subscriptionIds":[0,7]})", R"({"op":"subscribeConnectionGraph"})",
      std::string(100, '['), R"({"op":)" + std::string(20, '"') + "}"};
  const std::vector<std::string> calls{call("json", R"({"a":1})"), call("", ""),
                                       std::string("\x02\0\0\0\0\0\0\0\0\xff\xff\xff\xff", 13)};
  Random random(skein::test::seed_of_this_run());
  std::size_t messages = 0;
  for (int round = 0; round < 50'000; ++round) {
    std::string text = round % 8 == 0 ? random_bytes(random) : texts[random() % texts.size()];
    mutate(random, text);
    messages += is_message(decode_text, text) ? 1 : 0;
    std::string bytes = round % 8 == 0 ? random_bytes(random) : calls[random() % calls.size()];
    mutate(random, bytes);
    messages += is_message(decode_binary, bytes) ? 1 : 0;
  }
  CHECK(messages > 0);
  CHECK(messages < 100'000);
}
