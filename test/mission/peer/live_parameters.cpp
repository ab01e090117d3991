// What becomes of the parameters of components that run.
#include "mission/peer/live_parameters.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <future>
#include <optional>

#include "skein/error.hpp"

using namespace skein;
using namespace skein::launch;
using namespace std::chrono_literals;
using Catch::Contains;

namespace {

const profile::Dictionary& dictionary() {
  static const auto read = profile::parse_dictionary(
      R"(<dictionary>
           <parameter name="Period" type="duration" unit="ms" min="1" max="1000">Time.</parameter>
           <parameter name="Lift" type="real" unit="m" min="0">Height.</parameter>
           <parameter name="Tries" type="integer">How often.</parameter>
           <parameter name="Name" type="text">Who.</parameter>
         </dictionary>)",
      "dictionary.xml");
  return read;
}

struct Peer {
  int offered = 0;
  bool has_room = true;
  std::shared_ptr<LiveParameters> parameters = std::make_shared<LiveParameters>(
      dictionary(),
      [](const std::string& name, const ParameterValue& value) {
        if (name == "Name" && std::get<std::string>(value) == "nobody")
          throw InvalidArgument("somebody has to be named");
      },
      [this](const std::shared_ptr<ILiveParameters>&) {
        if (!has_room) throw Unavailable("no room for a service");
        ++offered;
      });
  ParameterValues values = parameters->values_of(
      "", {{"Period", "0.1 s", {}}, {"Lift", "3", {}}, {"Tries", "5", {}}, {"Name", "heron", {}}});

  RunningParameter of(const std::string& name) const {
    for (const RunningParameter& each : parameters->parameters())
      if (each.name == name) return each;
    FAIL("no " << name);
    return {};
  }
};

}  // namespace

TEST_CASE("a parameter that its component declared live takes another value while it runs") {
  const Peer peer;
  const auto period = peer.values.live<std::chrono::milliseconds>("Period");
  CHECK(period.get() == 100ms);
  const RunningParameter told = peer.parameters->set("Period", "0.25 s");
  CHECK(period.get() == 250ms);
  CHECK((told.value == "250" && told.unit == "ms" && told.type == "duration" && told.live));
  CHECK((told.minimum == std::vector{1.0} && told.maximum == std::vector{1000.0}));
  CHECK(peer.of("Period") == told);
}

TEST_CASE("a value that the dictionary forbids is refused as in a profile, and the old one stays") {
  const Peer peer;
  const auto period = peer.values.live<std::chrono::milliseconds>("Period");
  const auto lift = peer.values.live<double>("Lift");
  CHECK_THROWS_WITH(peer.parameters->set("Period", "250"), Contains("no unit of time"));
  CHECK_THROWS_WITH(peer.parameters->set("Period", "2 s"), Contains("more than 1000 ms"));
  CHECK_THROWS_WITH(peer.parameters->set("Lift", "high"), Contains("is no real"));
  CHECK_THROWS_AS(peer.parameters->set("Lift", "-1 km"), InvalidArgument);
  CHECK((period.get() == 100ms && lift.get() == 3));
  peer.parameters->set("Lift", "0.2 km");
  CHECK(lift.get() == 200);
}

TEST_CASE("a value that a plugin's check refuses does not come to the component") {
  const Peer peer;
  const auto name = peer.values.live<std::string>("Name");
  CHECK_THROWS_WITH(peer.parameters->set("Name", "nobody"), Contains("somebody has to be named"));
  CHECK(name.get() == "heron");
}

TEST_CASE("a component may refuse a value with a reason, and keeps the old one") {
  const Peer peer;
  const auto tries = peer.values.live<std::uint8_t>("Tries", [](std::uint8_t wanted) {
    if (wanted % 2 == 0) throw std::runtime_error("an even number decides nothing");
  });
  try {
    peer.parameters->set("Tries", "4");
    FAIL("it was taken");
  } catch (const ValueRefused& refusal) {
    CHECK(refusal.reason == "an even number decides nothing");
  }
  CHECK(tries.get() == 5);
  CHECK(peer.of("Tries").value == "5");
  CHECK_THROWS_AS(peer.parameters->set("Tries", "301"), ValueRefused);  // does not fit
  peer.parameters->set("Tries", "7");
  CHECK(tries.get() == 7);
}

TEST_CASE("what is asked for by a wrong name, or may not change, is told so") {
  const Peer peer;
  const auto period = peer.values.live<std::chrono::milliseconds>("Period");
  CHECK_THROWS_WITH(peer.parameters->set("Perid", "1 s"),
                    Contains("no parameter 'Perid'") && Contains("did you mean 'Period'?"));
  CHECK_THROWS_WITH(peer.parameters->set("Weather", "1 s"), Contains("Lift, Name, Period, Tries"));
  CHECK_FALSE(peer.of("Name").live);
  CHECK_THROWS_WITH(peer.parameters->set("Name", "crane"),
                    Contains("may not change while its component runs"));
}

TEST_CASE("a parameter is live as long as its component keeps it, and once at a time") {
  const Peer peer;
  auto name = std::make_optional(peer.values.live<std::string>("Name"));
  CHECK_THROWS_WITH(peer.values.live<std::string>("Name"), Contains("is live already"));
  const auto copy = name;
  name.reset();
  CHECK(peer.of("Name").live);
  peer.parameters->set("Name", "crane");
  CHECK(copy->get() == "crane");
}

TEST_CASE("a component that has let go of a parameter is not asked about it") {
  const Peer peer;
  int asked = 0;
  {
    const auto name = peer.values.live<std::string>("Name", [&](const std::string&) { ++asked; });
  }
  CHECK_THROWS_AS(peer.parameters->set("Name", "crane"), InvalidArgument);
  CHECK(asked == 0);
  const auto again = peer.values.live<std::string>("Name");
  CHECK(peer.of("Name").live);
}

TEST_CASE("a parameter that is declared anew begins with its profile's value, which is told, too") {
  const Peer peer;
  {
    const auto name = peer.values.live<std::string>("Name");
    peer.parameters->set("Name", "crane");
  }
  CHECK(peer.of("Name").value == "heron");
  const auto again = peer.values.live<std::string>("Name");
  CHECK(again.get() == "heron");
  CHECK(peer.of("Name").value == "heron");
}

TEST_CASE("while a component looks at a value, it may declare parameters and all may be read") {
  const Peer peer;
  std::string told;
  std::optional<LiveParameter<double>> lift;
  const auto name = peer.values.live<std::string>("Name", [&](const std::string&) {
    lift = peer.values.live<double>("Lift");
    told = peer.of("Name").value;
  });
  peer.parameters->set("Name", "crane");
  CHECK(told == "heron");
  CHECK(lift->get() == 3);
  CHECK(peer.of("Name").value == "crane");
}

TEST_CASE("who lets go of a parameter waits for the component's look at a value") {
  const Peer peer;
  std::promise<void> looks, may_go_on;
  std::atomic<bool> has_looked = false;
  auto name = std::make_optional(peer.values.live<std::string>("Name", [&](const std::string&) {
    looks.set_value();
    may_go_on.get_future().wait();
    has_looked = true;
  }));
  const auto set =
      std::async(std::launch::async, [&] { return peer.parameters->set("Name", "crane"); });
  looks.get_future().wait();
  auto letting_go = std::async(std::launch::async, [&] {
    name.reset();
    return has_looked.load();
  });
  may_go_on.set_value();
  CHECK(letting_go.get());
}

TEST_CASE("a parameter is declared, and offered, once there is room where there was none") {
  Peer peer;
  peer.has_room = false;
  CHECK_THROWS_AS(peer.values.live<std::string>("Name"), Unavailable);
  CHECK_FALSE(peer.of("Name").live);
  peer.has_room = true;
  const auto name = peer.values.live<std::string>("Name");
  CHECK(peer.of("Name").live);
  CHECK(peer.offered == 1);
}

TEST_CASE("the parameters of a CSP in its owner's process have its name before theirs") {
  const Peer peer;
  const auto values = peer.parameters->values_of("Rows.", {{"Lift", "8", {}}});
  const auto lift = values.live<double>("Lift");
  peer.parameters->set("Rows.Lift", "9");
  CHECK(lift.get() == 9);
  CHECK(peer.of("Lift").value == "3");
}

TEST_CASE("a peer offers its parameters once, when the first of them may change") {
  const Peer peer;
  CHECK(peer.offered == 0);
  const auto period = peer.values.live<std::chrono::milliseconds>("Period");
  const auto lift = peer.values.live<double>("Lift");
  CHECK(peer.offered == 1);
}

TEST_CASE("without a launcher a live parameter has the value that it was given") {
  const ParameterValues values{{"Lift", 3.5}};
  CHECK(values.live<double>("Lift").get() == 3.5);
  CHECK_THROWS_AS(values.live<double>("Tries"), InvalidArgument);
  CHECK_THROWS_AS(values.live<std::string>("Lift"), InvalidArgument);
}
