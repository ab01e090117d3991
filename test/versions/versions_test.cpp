#include <catch2/catch.hpp>

#include "brokerless_discovery/broker.hpp"
#include "sea_1.idl.hpp"
#include "sea_2.idl.hpp"
#include "sea_3.idl.hpp"
#include "skein/describe.hpp"
#include "test/connector/pairing.hpp"
#include "test/tools/eventually.hpp"
#include "test/tools/log.hpp"
#include "test/topics/heard.hpp"

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
  void tail(std::uint32_t, StreamSink<grown::Swell>&) override {}
};

struct ChangedBuoy : changed::Buoy {
  changed::Swell higher(const changed::Swell& swell, const std::vector<changed::Swell>&,
                        changed::Tide&) override {
    return swell;
  }
  changed::Weather weather(bool) override { return {}; }
  void waves(std::uint32_t, StreamSink<changed::Swell>&) override {}
};

struct OldHorn : old::Horn {
  std::uint32_t blow(std::uint32_t times) override { return times; }
};
struct GrownHorn : grown::Horn {
  std::uint32_t blow(std::uint32_t times) override { return times; }
  grown::Swell heard(const grown::Swell& swell) override { return swell; }
};

struct OldLight : old::Light {
  old::Colour colour() override { return old::Colour::Green; }
};
struct WhiteLight : grown::Light {
  grown::Colour colour() override { return grown::Colour::White; }
};

struct OldMast : old::Mast {
  double height_m() override { return 12; }
  void paint(const std::string&) override {}
};
struct PaintedMast : grown::Mast {
  double height_m() override { return 12; }
  void paint(const std::string&, std::int32_t) override {}
};
struct LeaningMast : changed::Mast {
  double height_m() override { return 12; }
  double lean_deg() override { return 1; }
};

/// Two entities, or one that calls itself.
struct Sea {
  explicit Sea(bool same_process = false) : client(same_process ? nullptr : make_client()) {}
  template <class Interface>
  typename Interface::Proxy connect() {
    return (client ? *client : *server).template connect<Interface>();
  }
  std::unique_ptr<Entity> server = make_server();
  std::unique_ptr<Entity> client;
};

/// Why a client of `Interface` is not connected to the only provider there is.
template <class Interface, class Provided>
std::string refusal(std::shared_ptr<Provided> provider) {
  Sea sea;
  const Guid id = sea.server->provide<Provided>(std::move(provider));
  REQUIRE(eventually([&] { return sea.client->broker().knows(id); }));
  try {
    sea.client->connect<Interface>({.timeout = std::chrono::milliseconds(1)});
  } catch (const Unavailable& refused) {
    return refused.what();
  }
  return "it was connected";
}

/// What is thrown where an operation is called that the provider lacks.
template <class Call>
std::string lacking(const Call& call) {
  try {
    call();
  } catch (const Unimplemented& error) {
    return error.what();
  }
  return "it was not refused";
}

}  // namespace

TEST_CASE("a client of the old version calls a provider of the grown one") {
  Sea sea(GENERATE(false, true));
  sea.server->provide<grown::Buoy>(std::make_shared<GrownBuoy>());
  auto buoy = sea.connect<old::Buoy>();

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

TEST_CASE("a client of the grown version calls a provider of the old one") {
  Sea sea(GENERATE(false, true));
  sea.server->provide<old::Buoy>(std::make_shared<OldBuoy>());
  auto buoy = sea.connect<grown::Buoy>();

  grown::Tide tide{3, 1};
  CHECK(buoy.higher({1, 5, "low"}, {{2, 6, "high"}}, tide) == grown::Swell{2, 8, {}});
  CHECK(tide == grown::Tide{2, 1});  // the old version has no moons, and so sends none
  CHECK(buoy.weather(true).swell() == grown::Swell{3.5, 8, {}});
  double expected = 0;
  for (const grown::Swell& wave : buoy.waves(20)) CHECK(wave == grown::Swell{expected++, 8, {}});
  CHECK(expected == 20);
  try {
    buoy.higher({6, 1, "six"}, {}, tide);
    FAIL("nothing was thrown");
  } catch (const grown::Adrift& adrift) {
    CHECK(adrift.last == grown::Swell{6, 8, {}});
  }
}

TEST_CASE("an @optional operation that the provider lacks ends as Unimplemented, by name") {
  Sea sea(GENERATE(false, true));
  sea.server->provide<old::Buoy>(std::make_shared<OldBuoy>());
  auto buoy = sea.connect<grown::Buoy>();

  const auto names_station = Catch::Contains("has no operation 'station'");
  CHECK_THAT(lacking([&] { buoy.station(); }), names_station);
  CHECK_THAT(lacking([&] { buoy.async_station().get(); }), names_station);
  CHECK_THAT(lacking([&] { buoy.tail(2).next(); }), Catch::Contains("has no operation 'tail'"));
  CHECK(buoy.weather(false).swell().height_m == 3.5);  // nothing of the connection was lost
}

TEST_CASE("what describes an interface says which operations a provider may lack") {
  CHECK_THAT(to_idl(describe(grown::Buoy::interface_info())),
             Catch::Contains("  @optional string station();") &&
                 Catch::Contains("  Weather weather(in boolean storm);"));
}

TEST_CASE("a provider that has all operations is taken before one that lacks an @optional one") {
  Sea sea;
  sea.server->provide<old::Horn>(std::make_shared<OldHorn>());
  REQUIRE(sea.connect<grown::Horn>().blow(3) == 3);
  const auto other = make_entity("younger", Pairing::get().server);  // behind "server" by name
  other->provide<grown::Horn>(std::make_shared<GrownHorn>());
  REQUIRE(eventually([&] { return sea.client->connect_all<grown::Horn>().size() == 2; }));
  CHECK(sea.connect<grown::Horn>().heard({2, 3, "far"}) == grown::Swell{2, 3, "far"});
}

TEST_CASE("an interface whose types cannot grow takes an operation of a type that can") {
  Sea sea(GENERATE(false, true));
  SECTION("the provider is the younger one") {
    sea.server->provide<grown::Horn>(std::make_shared<GrownHorn>());
    CHECK(sea.connect<old::Horn>().blow(7) == 7);
    CHECK(sea.connect<grown::Horn>().heard({1, 2, "near"}) == grown::Swell{1, 2, "near"});
  }
  SECTION("the client is the younger one") {
    sea.server->provide<old::Horn>(std::make_shared<OldHorn>());
    auto horn = sea.connect<grown::Horn>();
    CHECK(horn.blow(7) == 7);
    CHECK_THAT(lacking([&] {
                 horn.heard({1, 2, "near"});
               }),
               Catch::Contains("has no operation 'heard'"));
    CHECK(horn.blow(8) == 8);
  }
}

TEST_CASE("any other change is refused when connecting, with the operation or member") {
  const std::string of_member =
      "another version of it: the member sea::Swell.height_m has another name or type there (";
  CHECK_THAT(refusal<changed::Buoy>(std::make_shared<OldBuoy>()),
             Catch::Contains(of_member) && Catch::Contains(", here "));
  CHECK_THAT(refusal<old::Buoy>(std::make_shared<ChangedBuoy>()), Catch::Contains(of_member));

  // One went, and another, which is not @optional, came.
  CHECK_THAT(refusal<old::Mast>(std::make_shared<LeaningMast>()),
             Catch::Contains("operation 'paint' is missing there"));
  CHECK_THAT(refusal<changed::Mast>(std::make_shared<OldMast>()),
             Catch::Contains("operation 'lean_deg' is missing there"));
  // Another parameter.
  const std::string of_paint = "operation 'paint' has another signature there (";
  CHECK_THAT(refusal<old::Mast>(std::make_shared<PaintedMast>()),
             Catch::Contains(of_paint) && Catch::Contains("`skein describe sea::Mast` prints"));
  CHECK_THAT(refusal<grown::Mast>(std::make_shared<OldMast>()), Catch::Contains(of_paint));
  // An enumerator more: whoever does not know it has no value for it.
  const std::string of_colour = "operation 'colour' has another signature there (";
  CHECK_THAT(refusal<old::Light>(std::make_shared<WhiteLight>()), Catch::Contains(of_colour));
  CHECK_THAT(refusal<grown::Light>(std::make_shared<OldLight>()), Catch::Contains(of_colour));
}

TEST_CASE("the error of connect() says what differs, as the provider describes it") {
  const std::string told =
      "server (uav-1) offers another version of it: operation 'paint': parameter 'layers' is "
      "missing here; build both sides from the same IDL (`skein describe sea::Mast` prints";
  Sea sea;
  sea.server->provide<grown::Mast>(std::make_shared<PaintedMast>());
  const auto error = [](Entity& client, std::chrono::milliseconds timeout) {
    try {
      client.connect<old::Mast>({.timeout = timeout});
      return std::string("it was connected");
    } catch (const Unavailable& refused) {
      return std::string(refused.what());
    }
  };
  CHECK(eventually(
      [&] { return error(*sea.client, std::chrono::seconds(2)).find(told) != std::string::npos; }));
  SECTION("at once where it is in the same process") {
    CHECK_THAT(error(*sea.server, std::chrono::milliseconds(1)), Catch::Contains(told));
  }
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
  from_grown.publish({2.5, 6, "far"});
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
  CHECK(eventually([&] { return publisher.subscribers() == 1; }));
}

TEST_CASE("an enumerator that one side lacks is told on both sides, and nothing is taken") {
  const auto ship = make_server("ship");
  const auto shore = make_client("shore");
  const Log log;
  auto publisher = ship->publisher<grown::Lamp>("lamp", TopicQos::state());
  publisher.publish({grown::Colour::White});
  Heard<old::Lamp> heard;
  const auto subscription =
      shore->subscription<old::Lamp>("lamp", TopicQos::state(), heard.callback());
  const bool told = eventually([&] { return log.count("do not match in type") == 2; });
  CAPTURE(log.text());
  CHECK(told);
  CHECK(log.count("White") == 2);
  Heard<grown::Lamp> right;
  const auto other = shore->subscription<grown::Lamp>("lamp", TopicQos::state(), right.callback());
  REQUIRE(eventually([&] { return !right.values().empty(); }));
  CHECK(heard.values().empty());
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
