#include <catch2/catch.hpp>

#include "../connector/pairing.hpp"
#include "../tools/eventually.hpp"
#include "../tools/log.hpp"
#include "../topics/heard.hpp"
#include "sea_1.idl.hpp"
#include "sea_2.idl.hpp"
#include "sea_3.idl.hpp"

using namespace skein;
using namespace skein::test;

namespace old = version_1::sea;
namespace grown = version_2::sea;
namespace changed = version_3::sea;

namespace {

struct OldBuoy : old::Buoy {
  old::Swell higher(const old::Swell& swell, const std::vector<old::Swell>& others,
                    old::Tide& tide) override {
    if (others.empty()) throw old::Adrift(swell);
    tide.flow_m_s += 1;
    return std::max({swell, others.front()},
                    [](const auto& a, const auto& b) { return a.height_m < b.height_m; });
  }
  old::Weather weather(bool) override {
    old::Weather weather;
    weather.swell({3.5});
    return weather;
  }
  void waves(std::uint32_t count, StreamSink<old::Swell>& sink) override {
    for (std::uint32_t i = 0; i < count; ++i) sink.push({static_cast<double>(i)});
  }
};

struct GrownBuoy : grown::Buoy {
  grown::Swell higher(const grown::Swell& swell, const std::vector<grown::Swell>& others,
                      grown::Tide& tide) override {
    if (others.empty()) throw grown::Adrift({swell.height_m, swell.period_s, "last"});
    tide.moons *= 2;
    return {others.front().height_m, others.front().period_s, "higher"};
  }
  grown::Weather weather(bool storm) override {
    grown::Weather weather;
    if (storm) {
      weather.gust({30});
    } else {
      weather.swell({3.5, 7, {}});
    }
    return weather;
  }
  void waves(std::uint32_t count, StreamSink<grown::Swell>& sink) override {
    for (std::uint32_t i = 0; i < count; ++i) sink.push({static_cast<double>(i), 5, "wave"});
  }
  std::string station() override { return "north"; }
};

}  // namespace

TEST_CASE("a client of the old version calls a provider of the grown one") {
  const auto server = make_server();
  server->provide<grown::Buoy>(std::make_shared<GrownBuoy>());
  const bool same_process = GENERATE(false, true);
  const auto client = same_process ? nullptr : make_client();
  auto buoy = (client ? *client : *server).connect<old::Buoy>();

  old::Tide tide{1, 2};
  CHECK(buoy.higher({1}, {{2}, {3}}, tide) == old::Swell{2});
  CHECK(tide == old::Tide{1, 0});  // the grown version has no flow, and so sends none
  CHECK(buoy.weather(false).swell() == old::Swell{3.5});
  const old::Weather gust = buoy.weather(true);
  CHECK(gust.discriminator() == 2);
  CHECK_FALSE(gust.holds_swell());
  double expected = 0;
  for (const old::Swell& wave : buoy.waves(20)) CHECK(wave.height_m == expected++);
  CHECK(expected == 20);
  try {
    buoy.higher({6}, {}, tide);
    FAIL("nothing was thrown");
  } catch (const old::Adrift& adrift) {
    CHECK(adrift.last == old::Swell{6});
  }
}

TEST_CASE("a client of the grown version is told that the old one lacks an operation") {
  const auto server = make_server();
  server->provide<old::Buoy>(std::make_shared<OldBuoy>());
  const auto client = make_client();
  CHECK_THROWS_WITH(client->connect<grown::Buoy>({.timeout = std::chrono::milliseconds(500)}),
                    Catch::Contains("operation 'station' is missing there"));
}

TEST_CASE("any other change is refused, and both versions are named") {
  const auto server = make_server();
  server->provide<old::Buoy>(std::make_shared<OldBuoy>());
  const auto client = make_client();
  CHECK_THROWS_WITH(client->connect<changed::Buoy>({.timeout = std::chrono::milliseconds(500)}),
                    Catch::Contains("another version of it: the member sea::Swell.height_m has "
                                    "another name or type there (") &&
                        Catch::Contains(", here "));
}

TEST_CASE("a reader takes nothing from a writer of a version that it would misread") {
  const auto ship = make_server("ship");
  const auto shore = make_client("shore");
  const Log log;
  auto publisher = ship->publisher<old::Swell>("swell", TopicQos::state());
  Heard<changed::Swell> heard;
  const auto subscription =
      shore->subscription<changed::Swell>("swell", TopicQos::state(), heard.callback());
  CHECK(eventually([&] {  // each side is told
    return log.count(
               "topics: topic 'swell': a writer and a reader do not match in type: the "
               "writer offers sea::Swell.height_m in version ") == 2;
  }));
  publisher.publish({1.5});
  Heard<old::Swell> right;
  const auto other = shore->subscription<old::Swell>("swell", TopicQos::state(), right.callback());
  REQUIRE(eventually([&] { return !right.values().empty(); }));
  CHECK(heard.values().empty());
}

TEST_CASE("readers of either version of a type take what writers of the other one publish") {
  const auto ship = make_server("ship");
  const auto shore = make_client("shore");
  auto from_old = ship->publisher<old::Swell>("old", TopicQos::state());
  auto from_grown = ship->publisher<grown::Swell>("grown", TopicQos::state());
  from_old.publish({1.5});
  from_grown.publish({2.5, 6, {}});
  Heard<grown::Swell> heard_old;
  Heard<old::Swell> heard_grown;
  const auto first =
      shore->subscription<grown::Swell>("old", TopicQos::state(), heard_old.callback());
  const auto second =
      shore->subscription<old::Swell>("grown", TopicQos::state(), heard_grown.callback());
  REQUIRE(eventually([&] { return !heard_old.values().empty() && !heard_grown.values().empty(); }));
  CHECK(heard_old.values()[0] == grown::Swell{1.5, 8, {}});
  CHECK(heard_grown.values()[0] == old::Swell{2.5});
}

TEST_CASE("members that were swapped are told on both sides, and nothing is taken") {
  const auto ship = make_server("ship");
  const auto shore = make_client("shore");
  const Log log;
  auto publisher = ship->publisher<old::Fix>("fix", TopicQos::state());
  publisher.publish({1, 2});
  Heard<changed::Fix> heard;
  const auto subscription =
      shore->subscription<changed::Fix>("fix", TopicQos::state(), heard.callback());
  CHECK(eventually([&] {
    return log.count(
               "topics: topic 'fix': a writer and a reader do not match in type: the writer offers "
               "sea::Fix with 'double x_m', the reader requests sea::Fix with 'double y_m'; build "
               "both sides from the same version of the type") == 2;
  }));
  Heard<grown::Fix> right;
  const auto other = shore->subscription<grown::Fix>("fix", TopicQos::state(), right.callback());
  REQUIRE(eventually([&] { return !right.values().empty(); }));
  CHECK(right.values()[0] == grown::Fix{1, 2});
  CHECK(heard.values().empty());
  CHECK(subscription.publishers() == 0);
  CHECK(publisher.subscribers() == 1);
}

TEST_CASE("another type of the same topic is told by name") {
  const auto ship = make_server("ship");
  const auto shore = make_client("shore");
  const Log log;
  const auto publisher = ship->publisher<old::Fix>("fix", TopicQos::state());
  Heard<changed::Place> heard;
  const auto subscription =
      shore->subscription<changed::Place>("fix", TopicQos::state(), heard.callback());
  CHECK(eventually([&] {
    return log.count("the writer offers sea::Fix, the reader requests sea::Place") == 2;
  }));
}
