#include <catch2/catch.hpp>
#include <cstdlib>

#include "lookout.idl.hpp"
#include "test/connector/pairing.hpp"
#include "test/tools/child_process.hpp"
#include "test/tools/eventually.hpp"

using namespace skein;
using namespace skein::test;
using foreign::Sounding;

TEST_CASE("a peer without Skein hears a Skein publisher and is heard by a Skein subscriber") {
  ChildProcess repeater(std::getenv("FOREIGN_REPEATER"), {});
  const auto ship = make_server("ship");
  TopicQos qos;
  qos.systems = {""};
  auto soundings = ship->publisher<Sounding>("soundings", qos);
  auto repeated = ship->subscription<Sounding>("repeated", qos);
  REQUIRE(eventually([&] { return soundings.subscribers() == 1 && repeated.publishers() == 1; }));
  // A match does not say that the other side hears yet: an answer does.
  REQUIRE(eventually([&] {
    soundings.publish({1, 1, "try", {}});
    return repeated.take().has_value();
  }));
  constexpr int kCount = 200;
  for (int i = 0; i < kCount; ++i) soundings.publish({1, 0.5 * i, "keel", {1, 2, 3}});
  soundings.publish({1, -7, "enough", {}});
  std::vector<Sounding> heard;
  REQUIRE(eventually([&] {
    while (const auto value = repeated.take()) {
      if (value->note != "try") heard.push_back(*value);
    }
    return !heard.empty() && heard.back().note == "enough";
  }));
  REQUIRE(heard.size() == kCount + 1);
  for (int i = 0; i < kCount; ++i) CHECK(heard[i] == Sounding{1, 1.0 * i, "keel", {1, 2, 3}});
  CHECK(heard.back() == Sounding{1, -14, "enough", {}});
  CHECK(repeated.counters().malformed == 0);
  CHECK(repeater.finish() == 0);
}
