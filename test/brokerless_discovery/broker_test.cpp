#include "skein/brokerless_discovery/broker.hpp"

#include <catch2/catch.hpp>
#include <thread>

#include "../tools/eventually.hpp"
#include "descriptions.hpp"
#include "skein/brokerless_discovery/process_watch.hpp"
#include "skein/core/error.hpp"
#include "skein/dds/loopback.hpp"

using namespace skein;
using namespace skein::brokerless_discovery;
using namespace std::chrono_literals;
using skein::test::description;
using skein::test::eventually;
using skein::test::guid;

namespace {

/// A network on which time passes only when told.
struct World {
  ManualClock clock;
  dds::LoopbackNetwork network{clock};
};

/// A peer's Broker; callbacks wait in `control` until run.
struct Peer {
  Peer(World& world, const std::string& entity, const std::string& system = "uav-1")
      : participant(world.network.vendor()->create_participant({})),
        broker(*participant, world.clock, control, watch, {system, entity, "loopback", 1000ms}) {}

  bool finds(const std::string& name) const {
    return !broker.find_service(broker.query(name)).empty();
  }

  ManualExecutor control;
  ProcessWatch watch;
  std::unique_ptr<dds::Participant> participant;
  Broker broker;
};

/// Lets time pass in steps, as it does, and runs what it brings.
void pass(World& world, std::initializer_list<Peer*> peers, Duration time) {
  for (Duration passed{}; passed < time; passed += 50ms) {
    world.clock.advance(50ms);
    for (Peer* peer : peers) peer->control.run_all();
  }
}

}  // namespace

TEST_CASE("a late joiner receives every description that stands", "[R16]") {
  World world;
  Peer early(world, "navigator");
  const auto one = early.broker.add_service(description(1, "A/INavigator", "navigator"));
  const auto two = early.broker.add_service(description(2, "A/IOther", "navigator"));
  const Peer late(world, "ground");
  CHECK(late.finds("A/INavigator"));
  CHECK(late.finds("A/IOther"));
}

TEST_CASE("a peer knows its own services at once, and forgets them when they are withdrawn",
          "[R10]") {
  World world;
  Peer navigator(world, "navigator");
  Peer ground(world, "ground");
  {
    const auto registration =
        navigator.broker.add_service(description(1, "A/INavigator", "navigator"));
    CHECK(navigator.finds("A/INavigator"));
    CHECK(ground.finds("A/INavigator"));
  }
  CHECK_FALSE(navigator.finds("A/INavigator"));
  CHECK_FALSE(ground.finds("A/INavigator"));
}

TEST_CASE("a description carries host, process, pid and vendor of its peer") {
  World world;
  Peer navigator(world, "navigator");
  Peer ground(world, "ground");
  const auto registration =
      navigator.broker.add_service(description(1, "A/INavigator", "navigator"));
  const auto found = ground.broker.find_service(ground.broker.query("navigator")).at(0);
  CHECK(found->host == ProcessWatch::host());
  CHECK(found->process == navigator.watch.address());
  CHECK(found->pid == static_cast<std::uint32_t>(getpid()));
  CHECK(found->vendor == "loopback");
}

TEST_CASE("a managed description does not reach strangers", "[R6]") {
  World world;
  Peer csp(world, "navigator.AStar");
  Peer owner(world, "navigator");
  Peer namesake(world, "navigator", "uav-2");
  Peer stranger(world, "ground");
  auto planner = description(1, "A/IPlanner", "AStar");
  planner.owner = "uav-1/navigator";
  const auto registration = csp.broker.add_service(planner);
  CHECK(owner.finds("A/IPlanner"));
  CHECK_FALSE(stranger.finds("A/IPlanner"));
  CHECK(stranger.broker.all().empty());
  CHECK(namesake.broker.all().empty());
}

TEST_CASE("a provider that is stopped is suspect after its lease and comes back by itself",
          "[R11][R12][R17]") {
  World world;
  Peer navigator(world, "navigator");
  Peer ground(world, "ground");
  const auto registration =
      navigator.broker.add_service(description(1, "A/INavigator", "navigator"));

  world.network.pause(navigator.participant->guid());
  pass(world, {&ground}, 1500ms);
  CHECK_FALSE(ground.finds("A/INavigator"));

  world.network.resume(navigator.participant->guid());
  pass(world, {&navigator, &ground}, 1500ms);
  CHECK(ground.finds("A/INavigator"));
}

TEST_CASE("descriptions come back after a partition", "[R13][R17]") {
  World world;
  Peer navigator(world, "navigator");
  Peer ground(world, "ground");
  const auto registration =
      navigator.broker.add_service(description(1, "A/INavigator", "navigator"));

  world.network.separate(navigator.participant->guid(), ground.participant->guid());
  pass(world, {&navigator, &ground}, 30s);
  CHECK_FALSE(ground.finds("A/INavigator"));
  CHECK(navigator.finds("A/INavigator"));

  world.network.heal();
  pass(world, {&navigator, &ground}, 2s);
  CHECK(ground.finds("A/INavigator"));
}

TEST_CASE("a peer that vanishes takes its descriptions with it", "[R13]") {
  World world;
  Peer navigator(world, "navigator");
  Peer ground(world, "ground");
  const auto registration =
      navigator.broker.add_service(description(1, "A/INavigator", "navigator"));
  std::vector<Change> changes;
  const auto observation =
      ground.broker.observe([&](const Change& change) { changes.push_back(change); });

  world.network.kill(navigator.participant->guid());
  pass(world, {&ground}, 5s);
  CHECK(ground.broker.all().empty());
  REQUIRE_FALSE(changes.empty());
  CHECK(changes.back().kind == Change::Kind::Removed);
  CHECK(changes.back().departure == Departure::Lost);
}

TEST_CASE("the end of a process is known without any lease", "[R14][R15]") {
  World world;
  auto navigator = std::make_unique<Peer>(world, "navigator");
  Peer ground(world, "ground");
  // The watch is the process as far as others can see; here it ends before its participant does.
  auto process = std::make_unique<ProcessWatch>();
  auto ghost = description(1, "A/INavigator", "navigator");
  Broker broker(*navigator->participant, world.clock, navigator->control, *process,
                {"uav-1", "navigator", "loopback", 1000ms});
  const auto registration = broker.add_service(ghost);
  REQUIRE(ground.finds("A/INavigator"));
  process.reset();
  CHECK(eventually([&] { return !ground.finds("A/INavigator"); }));
}

TEST_CASE("observers hear of what comes and goes until they stop listening") {
  World world;
  Peer navigator(world, "navigator");
  Peer ground(world, "ground");
  std::vector<Change::Kind> kinds;
  auto observation =
      ground.broker.observe([&](const Change& change) { kinds.push_back(change.kind); });
  auto registration = navigator.broker.add_service(description(1, "A/INavigator", "navigator"));
  registration.withdraw();
  ground.control.run_all();
  CHECK(kinds == std::vector{Change::Kind::Added, Change::Kind::Removed});

  observation.withdraw();
  const auto again = navigator.broker.add_service(description(2, "A/INavigator", "navigator"));
  ground.control.run_all();
  CHECK(kinds.size() == 2);
}

TEST_CASE("the table's generation stands while nothing changes, and grows with each change") {
  World world;
  Peer navigator(world, "navigator");
  Peer ground(world, "ground");
  const auto begin = ground.broker.generation();
  auto registration = navigator.broker.add_service(description(1, "A/INavigator", "navigator"));
  REQUIRE(ground.finds("A/INavigator"));
  const auto added = ground.broker.generation();
  CHECK(added > begin);
  pass(world, {&navigator, &ground}, 5s);
  CHECK(ground.broker.generation() == added);
  registration.withdraw();
  CHECK(ground.broker.generation() > added);
}

TEST_CASE("waiting for a service ends when it appears") {
  World world;
  Peer ground(world, "ground");
  Peer navigator(world, "navigator");
  Table::Found found;
  std::thread waiting([&] {
    found = ground.broker.await_service(ground.broker.query("navigator"), world.clock.now() + 1h);
  });
  const auto registration =
      navigator.broker.add_service(description(1, "A/INavigator", "navigator"));
  waiting.join();
  CHECK(found.size() == 1);
}

TEST_CASE("waiting for a service that does not appear ends at the deadline with the reason",
          "[R9]") {
  World world;
  Peer ground(world, "ground");
  CHECK_THROWS_WITH(
      ground.broker.await_service(ground.broker.query("navigator"), world.clock.now()),
      Catch::Contains("nothing of that name"));
}

TEST_CASE("a malformed description is dropped and the others stand", "[R4]") {
  World world;
  Peer navigator(world, "navigator");
  Peer ground(world, "ground");
  const auto registration =
      navigator.broker.add_service(description(1, "A/INavigator", "navigator"));
  dds::Qos qos;
  qos.transient_local = true;
  qos.history_depth = 1;
  qos.liveliness_lease = 1000ms;
  const auto stranger = world.network.vendor()->create_participant({});
  const auto writer = stranger->create_writer(
      {"skein/services", "skein::discovery::ServiceDescription", true}, qos);
  const std::uint8_t truncated[] = {0, 1, 0, 0, 1, 2, 3};
  writer->write(std::as_bytes(std::span(truncated)), guid(9));
  CHECK(ground.broker.all().size() == 1);
}

TEST_CASE("names that would not survive the wire are refused") {
  World world;
  CHECK_THROWS_AS(Peer(world, "two words"), InvalidArgument);
  CHECK_THROWS_AS(Peer(world, "*"), InvalidArgument);
  CHECK_THROWS_AS(Peer(world, "navigator", ""), InvalidArgument);
  CHECK_THROWS_AS(Peer(world, "wild[card]"), InvalidArgument);
}
