#include <catch2/catch.hpp>
#include <fstream>
#include <sstream>

#include "dds/port/sample_format.hpp"
#include "greeter.idl.hpp"
#include "rpc/wire/reply_encoding.hpp"
#include "rpc/wire/wire.hpp"
#include "test/tools/places.hpp"

using namespace std::chrono_literals;
using skein::rpc::wire::RequestId;
using skein::test::project_file;

namespace {

const RequestId kId{*skein::Guid::from_hex("010f123456789abc0000000100000a03"), 1};

/// What stands before the bar in each line of each ```hex block of idl/README.md.
std::vector<std::string> quoted_bytes() {
  std::vector<std::string> blocks;
  std::ifstream file(project_file("idl/README.md"));
  bool inside = false;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("```")) {
      inside = line == "```hex";
      if (inside) blocks.emplace_back();
    } else if (inside) {
      std::istringstream bytes(line.substr(0, line.find('|')));
      for (std::string byte; bytes >> byte;) blocks.back() += byte;
    }
  }
  return blocks;
}

/// As the sample travels: padded to a multiple of four.
std::string on_the_wire(const skein::Bytes& message) {
  std::vector<std::byte> sample(skein::dds::padded(message.size()));
  skein::dds::copy_padded(message, sample.data());
  std::string text;
  for (const std::byte byte : sample) {
    constexpr char kDigits[] = "0123456789abcdef";
    text += kDigits[std::to_integer<int>(byte) >> 4];
    text += kDigits[std::to_integer<int>(byte) & 15];
  }
  return text;
}

}  // namespace

TEST_CASE("the request and the reply of idl/README.md are those that travel") {
  const auto& greet = greeting::IGreeter::interface_info().operations[0];
  CHECK(greet.signature == 0x298636e5c56e9ef4);
  const auto quoted = quoted_bytes();
  REQUIRE(quoted.size() == 2);

  greeting::IGreeter_greet_In in;
  in.name.own() = "world";
  skein::Bytes request;
  skein::rpc::wire::begin_request(request, kId, greet.hash);
  greet.in->encode(&in, request);
  skein::rpc::wire::RequestTrailer trailer;
  trailer.remaining = 5s;
  trailer.sent = 90s;
  skein::rpc::wire::append_trailer(request, trailer);
  CHECK(on_the_wire(request) == quoted[0]);

  greeting::IGreeter_greet_Out out;
  out.return_ = "Hello, world!";
  skein::Bytes reply;
  skein::rpc::encode_outcome(reply, skein::Representation::Xcdr1, kId, greet, &out, nullptr);
  CHECK(on_the_wire(reply) == quoted[1]);
}
