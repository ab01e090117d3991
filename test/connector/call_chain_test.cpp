#include <catch2/catch.hpp>

#include "pairing.hpp"
#include "relay_service.hpp"
#include "test/tools/child_process.hpp"
#include "test/tools/places.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;
using ::test::Relay;

namespace {

ChildProcess start_relay(const dds::Vendor& vendor, const std::string& name) {
  ChildProcess relay(built_program("relay_process"), {.arguments = {vendor.name(), name}});
  relay.expect("ready");
  return relay;
}

}  // namespace

TEST_CASE(
    "a chain of calls through other processes that comes back to a blocked service is refused "
    "there") {
  const auto& vendors = Pairing::get();
  auto alpha = start_relay(*vendors.server, "alpha");
  auto beta = start_relay(*vendors.client, "beta");
  auto gamma = start_relay(*vendors.server, "gamma");
  const auto client = make_client();
  auto relay = client->connect<Relay>({.name = "alpha", .timeout = 20s}).within(60s);

  CHECK(relay.pass_on({"beta", "gamma"}) == "alpha beta gamma");
  CHECK_THROWS_AS(relay.pass_on({"beta", "gamma", "alpha"}), Unavailable);
  CHECK_THROWS_WITH(
      relay.pass_on({"beta", "gamma", "alpha"}),
      Catch::Contains(
          "wait for itself (test::Relay of alpha (uav-1) -> test::Relay of beta (uav-1) "
          "-> test::Relay of gamma (uav-1) -> the first again)"));
  CHECK_THROWS_WITH(relay.pass_on({"beta", "gamma", "beta"}),
                    Catch::Contains("(test::Relay of beta (uav-1) -> test::Relay of gamma (uav-1) "
                                    "-> the first again)"));
  CHECK(relay.pass_on({"gamma", "beta"}) == "alpha gamma beta");
}
