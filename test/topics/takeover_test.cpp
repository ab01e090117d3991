#include <algorithm>
#include <catch2/catch.hpp>
#include <csignal>

#include "heard.hpp"
#include "streams.idl.hpp"
#include "test/connector/pairing.hpp"
#include "test/tools/child_process.hpp"
#include "test/tools/eventually.hpp"

using namespace skein;
using namespace skein::test;
using streams::Rudder;

namespace {

/// Waits until the newest command comes from `source` alone, a few times in a row.
bool obeys(const Heard<Rudder>& heard, const std::string& source) {
  constexpr std::size_t kRow = 5;
  return eventually([&] {
    const auto values = heard.values();
    return values.size() >= kRow &&
           std::all_of(values.end() - kRow, values.end(),
                       [&](const Rudder& each) { return each.source == source; });
  });
}

}  // namespace

TEST_CASE(
    "when the stronger commander is killed, the weaker is obeyed; when one returns, that one "
    "again") {
  const std::string vendor = Pairing::get().server->name();
  const auto commander = [&](const std::string& name, const std::string& strength) {
    ChildProcess::Options options;
    options.arguments = {vendor, name, strength};
    ChildProcess child("streams_peer", options);
    child.expect("commanding");
    return child;
  };
  const auto boat = make_client("boat");
  Heard<Rudder> heard;
  const auto watch = boat->subscription<Rudder>("rudder", TopicQos::command(), heard.callback());
  auto autopilot = commander("autopilot", "1");
  REQUIRE(obeys(heard, "autopilot"));
  auto skipper = commander("skipper", "2");
  REQUIRE(obeys(heard, "skipper"));
  skipper.signal(SIGKILL);
  REQUIRE(obeys(heard, "autopilot"));
  CHECK(watch.counters().missed_deadlines > 0);
  auto mate = commander("mate", "2");
  REQUIRE(obeys(heard, "mate"));
  mate.finish();
  CHECK(obeys(heard, "autopilot"));
}
