#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <future>

#include "heard.hpp"
#include "streams.idl.hpp"
#include "test/connector/pairing.hpp"
#include "test/tools/eventually.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;
using streams::Rudder;
using streams::Sighting;
using streams::Wave;

namespace {

/// A reader that a busy machine keeps from its work for long is slow to acknowledge.
void publish_when_there_is_room(Publisher<Rudder>& rudder, const Rudder& value) {
  REQUIRE(eventually([&] {
    try {
      rudder.publish(value);
      return true;
    } catch (const Overloaded&) {
      return false;
    }
  }));
}

}  // namespace

TEST_CASE("a reliable stream arrives complete and in order") {
  const auto ship = make_server("ship");
  const auto shore = make_client("shore");
  Heard<Rudder> heard;
  const auto watch = shore->subscription<Rudder>("rudder", {}, heard.callback());
  auto rudder = ship->publisher<Rudder>("rudder");
  REQUIRE(eventually([&] { return rudder.subscribers() == 1 && watch.publishers() == 1; }));
  REQUIRE(eventually([&] {
    rudder.publish({"try", 0});
    return !heard.values().empty();
  }));
  for (int i = 1; i <= 500; ++i) {
    publish_when_there_is_room(rudder, {"helm", static_cast<double>(i)});
  }
  REQUIRE(eventually([&] { return heard.values().back().angle_deg == 500; }));
  std::vector<double> angles;
  for (const Rudder& value : heard.values()) {
    if (value.source == "helm") angles.push_back(value.angle_deg);
  }
  REQUIRE(angles.size() == 500);
  CHECK(std::is_sorted(angles.begin(), angles.end()));
  CHECK(watch.counters().dropped == 0);
  CHECK(watch.counters().received == heard.values().size());
}

TEST_CASE("types that may grow arrive, with their keys, as others do") {
  const auto ship = make_server("ship");
  auto sightings = ship->publisher<Sighting>("sighting", TopicQos::state());
  const Sighting near{3, 1ULL << 40, 12.5, "near"};
  const Sighting far{3, 2, std::nullopt, "far"};
  for (const Sighting& each : {near, far}) sightings.publish(each);
  const auto shore = make_client("shore");
  Heard<Sighting> heard;
  std::atomic<int> disposed = 0;
  SubscriptionOptions options;
  options.on_disposed = [&](const Guid& key) {
    if (key == key_hash(near)) ++disposed;
  };
  const auto watch =
      shore->subscription<Sighting>("sighting", TopicQos::state(), heard.callback(), options);
  REQUIRE(eventually([&] { return heard.values().size() == 2; }));
  CHECK(heard.values()[0] == near);
  CHECK(heard.values()[1] == far);
  sightings.dispose(near);
  CHECK(eventually([&] { return disposed == 1; }));

  Heard<Wave> waves;
  const auto buoy = shore->subscription<Wave>("wave", TopicQos::state(), waves.callback());
  auto sea = ship->publisher<Wave>("wave", TopicQos::state());
  sea.publish({2.5, {1, 2, 3}});
  REQUIRE(eventually([&] { return waves.values().size() == 1; }));
  CHECK(waves.values()[0] == Wave{2.5, {1, 2, 3}});
}

TEST_CASE("a subscriber that does not return from its callback holds up nobody else") {
  const auto ship = make_server("ship");
  const auto stuck_shore = make_client("stuck");
  const auto shore = make_client("shore");
  TopicQos qos;
  qos.max_waiting = 8;
  std::promise<void> promise;
  const auto stuck = stuck_shore->subscription<Rudder>(
      "rudder", qos, [go_on = promise.get_future().share()](const Rudder&) { go_on.wait(); });
  // Ends before `stuck`, which waits for its callback, also when something fails.
  std::promise<void> go_on = std::move(promise);
  Heard<Rudder> heard;
  const auto watch = shore->subscription<Rudder>("rudder", {}, heard.callback());
  auto rudder = ship->publisher<Rudder>("rudder");
  REQUIRE(eventually([&] { return rudder.subscribers() == 2; }));
  REQUIRE(eventually([&] { return stuck.publishers() == 1 && watch.publishers() == 1; }));
  // More than a writer may have unacknowledged.
  for (int i = 1; i <= 3000; ++i) {
    publish_when_there_is_room(rudder, {"helm", static_cast<double>(i)});
    if (i % 500 == 0) {
      REQUIRE(eventually(
          [&] { return !heard.values().empty() && heard.values().back().angle_deg == i; }));
    }
  }
  CHECK(stuck.counters().dropped > 2000);
  CHECK(watch.counters().dropped == 0);
  go_on.set_value();
  CHECK(eventually([&] { return stuck.counters().received >= 8; }));
}
