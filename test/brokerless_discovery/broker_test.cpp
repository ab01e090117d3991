#include "brokerless_discovery/broker.hpp"

#include <catch2/catch.hpp>
#include <condition_variable>
#include <future>
#include <thread>

#include "brokerless_discovery/process_watch.hpp"
#include "descriptions.hpp"
#include "skein/detail/codec.hpp"
#include "skein/error.hpp"
#include "skein/loopback.hpp"
#include "test/tools/eventually.hpp"
#include "test/tools/log.hpp"

using namespace skein;
using namespace skein::brokerless_discovery;
using namespace std::chrono_literals;
using skein::test::description;
using skein::test::eventually;
using skein::test::guid;

namespace {

/// A network on which time passes only when told.
struct World {
  std::unique_ptr<dds::Writer> services_writer(dds::Participant& participant) {
    dds::Qos qos;
    qos.transient_local = true;
    qos.history_depth = 1;
    qos.liveliness_lease = 1000ms;
    return participant.create_writer(
        {"skein/services", "skein::discovery::ServiceDescription", true}, qos);
  }

  ManualClock clock;
  dds::LoopbackNetwork network{clock};
};

/// Who writes descriptions as he likes.
struct Writer {
  explicit Writer(World& world)
      : participant(world.network.vendor()->create_participant({})),
        writer(world.services_writer(*participant)) {}

  discovery::ServiceDescription describe(std::uint8_t number, const std::string& service) const {
    auto result = description(number, service, "stranger");
    result.provider = guid(number, participant->guid()).bytes;
    result.process = "";
    return result;
  }

  void write(const discovery::ServiceDescription& description) const {
    write(description, {description.provider});
  }
  void write(const discovery::ServiceDescription& description, const Guid& key) const {
    writer->write(idl::encode_message(description), key);
  }

  std::unique_ptr<dds::Participant> participant;
  std::unique_ptr<dds::Writer> writer;
};

/// A peer's Broker; callbacks wait in `control` until run.
struct Peer {
  Peer(World& world, const std::string& entity, const std::string& system = "uav-1",
       decltype(Broker::Options::tell_types) tell_types = {})
      : participant(world.network.vendor()->create_participant({})),
        broker(*participant, world.clock, control, watch,
               {system, entity, "loopback", 1000ms, "", std::move(tell_types)}) {}

  /// A description of one of its services.
  discovery::ServiceDescription describe(std::uint8_t number, const std::string& service,
                                         const std::string& entity) const {
    auto result = description(number, service, entity);
    result.provider = guid(number, participant->guid()).bytes;
    return result;
  }

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
  const auto one = early.broker.add_service(early.describe(1, "A/INavigator", "navigator"));
  const auto two = early.broker.add_service(early.describe(2, "A/IOther", "navigator"));
  const Peer late(world, "ground");
  CHECK(late.finds("A/INavigator"));
  CHECK(late.finds("A/IOther"));
}

TEST_CASE("a registration that gives way to another is withdrawn at once") {
  World world;
  Peer navigator(world, "navigator");
  auto one = navigator.broker.add_service(navigator.describe(1, "A/INavigator", "navigator"));
  auto two = navigator.broker.add_service(navigator.describe(2, "A/IOther", "navigator"));
  one = std::move(two);
  CHECK_FALSE(navigator.finds("A/INavigator"));
  CHECK(navigator.finds("A/IOther"));
  one = Broker::Registration();
  CHECK_FALSE(navigator.finds("A/IOther"));
}

TEST_CASE("a peer knows its own services at once, and forgets them when they are withdrawn",
          "[R10]") {
  World world;
  Peer navigator(world, "navigator");
  Peer ground(world, "ground");
  {
    const auto registration =
        navigator.broker.add_service(navigator.describe(1, "A/INavigator", "navigator"));
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
      navigator.broker.add_service(navigator.describe(1, "A/INavigator", "navigator"));
  const auto found = ground.broker.find_service(ground.broker.query("navigator")).at(0);
  CHECK(found->host == ProcessWatch::host());
  CHECK(ProcessWatch::is_address_of(navigator.participant->guid(), found->process));
  CHECK(found->pid == static_cast<std::uint32_t>(getpid()));
  CHECK(found->vendor == "loopback");
}

TEST_CASE("a managed description does not reach strangers", "[R6]") {
  World world;
  Peer csp(world, "navigator.AStar");
  Peer owner(world, "navigator");
  Peer namesake(world, "navigator", "uav-2");
  Peer stranger(world, "ground");
  auto planner = csp.describe(1, "A/IPlanner", "AStar");
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
      navigator.broker.add_service(navigator.describe(1, "A/INavigator", "navigator"));

  world.network.pause(navigator.participant->guid());
  pass(world, {&ground}, 1500ms);
  CHECK_FALSE(ground.finds("A/INavigator"));

  world.network.resume(navigator.participant->guid());
  pass(world, {&navigator, &ground}, 1500ms);
  CHECK(ground.finds("A/INavigator"));
}

TEST_CASE("while a provider stays suspect, each request for all descriptions waits longer",
          "[R17]") {
  World world;
  Peer ground(world, "ground");
  dds::ParticipantOptions options;
  options.lease = 10min;
  const auto stranger = world.network.vendor()->create_participant(options);
  const auto writer = world.services_writer(*stranger);
  auto service = description(1, "A/INavigator", "stranger");
  service.provider = guid(1, stranger->guid()).bytes;
  service.process = "";
  writer->write(idl::encode_message(service), {service.provider});
  REQUIRE(ground.finds("A/INavigator"));

  int requests = 0;
  const auto onlooker = world.network.vendor()->create_participant({});
  dds::Qos qos;
  qos.transient_local = true;
  qos.liveliness_lease = 1000ms;
  const auto asked = onlooker->create_writer(
      {"skein/services", "skein::discovery::ServiceDescription", true}, qos,
      {.on_matched = [&](const Guid&, bool matched) { requests += matched; }});
  requests = 0;
  world.network.pause(stranger->guid());
  pass(world, {&ground}, 2s);
  REQUIRE(ground.broker.all().size() == 1);
  REQUIRE_FALSE(ground.finds("A/INavigator"));

  requests = 0;
  pass(world, {&ground}, 60s);
  CHECK(requests >= 3);
  CHECK(requests <= 6);
}

TEST_CASE("descriptions come back after a partition", "[R13][R17]") {
  World world;
  Peer navigator(world, "navigator");
  Peer ground(world, "ground");
  const auto registration =
      navigator.broker.add_service(navigator.describe(1, "A/INavigator", "navigator"));

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
      navigator.broker.add_service(navigator.describe(1, "A/INavigator", "navigator"));
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
  Peer ground(world, "ground");
  Writer navigator(world);
  // The watch is the process as far as others can see; here it ends before its participant does.
  auto process = std::make_unique<ProcessWatch>();
  auto ghost = navigator.describe(1, "A/INavigator");
  ghost.host = ProcessWatch::host();
  ghost.process = process->open(navigator.participant->guid());
  navigator.write(ghost);
  REQUIRE(ground.finds("A/INavigator"));
  CHECK(eventually([&] { return process->counters().watchers == 1; }));
  process.reset();
  CHECK(eventually([&] { return !ground.finds("A/INavigator"); }));
  navigator.write(ghost);
  CHECK_FALSE(ground.finds("A/INavigator"));
}

TEST_CASE("whom nobody describes any more is not watched", "[R27]") {
  World world;
  Peer ground(world, "ground");
  Writer navigator(world);
  auto one = navigator.describe(1, "A/INavigator");
  auto two = navigator.describe(2, "A/IOther");
  one.host = two.host = ProcessWatch::host();
  {
    ProcessWatch own;
    one.process = two.process = own.open(navigator.participant->guid());
    navigator.write(one);
    navigator.write(two);
    CHECK(ground.watch.counters().watched == 1);
    navigator.writer->dispose({one.provider});
    CHECK(ground.watch.counters().watched == 1);
    navigator.writer->dispose({two.provider});
    CHECK(ground.watch.counters().watched == 0);
    CHECK(eventually([&] { return own.counters().watchers == 0; }));
  }
  CHECK(ground.broker.all().empty());
}

TEST_CASE("two entities of one process both hear of another process's end", "[R14]") {
  World world;
  ManualExecutor control;
  ProcessWatch shared;
  const auto here = world.network.vendor()->create_participant({});
  const auto there = world.network.vendor()->create_participant({});
  Broker first(*here, world.clock, control, shared, {"uav-1", "first", "loopback", 1000ms});
  Broker second(*there, world.clock, control, shared, {"uav-1", "second", "loopback", 1000ms});
  Writer navigator(world);
  auto process = std::make_unique<ProcessWatch>();
  auto described = navigator.describe(1, "A/INavigator");
  described.host = ProcessWatch::host();
  described.process = process->open(navigator.participant->guid());
  navigator.write(described);
  REQUIRE(first.all().size() == 1);
  REQUIRE(second.all().size() == 1);
  process.reset();
  CHECK(eventually([&] { return first.all().empty() && second.all().empty(); }));
}

TEST_CASE("a rogue neither withdraws another's service nor takes it with him when he goes",
          "[R23]") {
  World world;
  Peer navigator(world, "navigator");
  Peer ground(world, "ground");
  const auto registration =
      navigator.broker.add_service(navigator.describe(1, "A/INavigator", "navigator"));
  auto rogue = std::make_unique<Writer>(world);
  auto claimed = navigator.describe(1, "A/INavigator", "navigator");
  claimed.process = "";

  SECTION("by withdrawing it") { rogue->writer->dispose({claimed.provider}); }
  SECTION("by describing it, and going") {
    rogue->write(claimed);
    rogue.reset();
  }
  SECTION("by describing it as an own service's sample, and going") {
    rogue->write(claimed, guid(1, rogue->participant->guid()));
    rogue.reset();
  }
  pass(world, {&navigator, &ground}, 5s);
  CHECK(ground.finds("A/INavigator"));
  CHECK(ground.broker.refused(Refusal::Forged) + ground.broker.refused(Refusal::Malformed) == 1);
  CHECK(Peer(world, "late").finds("A/INavigator"));
}

TEST_CASE("a rogue's description names no process but his own", "[R23][R27]") {
  World world;
  Peer navigator(world, "navigator");
  Peer ground(world, "ground");
  const auto registration =
      navigator.broker.add_service(navigator.describe(1, "A/INavigator", "navigator"));
  const auto described = ground.broker.all().at(0);
  Writer rogue(world);
  auto claim = rogue.describe(1, "A/IPlanner");
  claim.host = described->host;
  claim.process = described->process;
  rogue.write(claim);
  CHECK_FALSE(ground.finds("A/IPlanner"));
  CHECK(ground.broker.refused(Refusal::Forged) == 1);
}

TEST_CASE(
    "who hears himself withdrawn, or described otherwise, writes again, but not at once each "
    "time",
    "[R24]") {
  World world;
  Peer navigator(world, "navigator");
  Peer ground(world, "ground");
  const auto registration =
      navigator.broker.add_service(navigator.describe(1, "A/INavigator", "navigator"));
  std::size_t written = 0;
  world.network.judge_transfers([&](const dds::Transfer& transfer) {
    if (transfer.topic == "skein/services" &&
        transfer.reader.participant() == ground.participant->guid()) {
      ++written;
    }
    return dds::Fate::deliver();
  });
  // As good as a forged GUID.
  const auto forged = world.services_writer(*navigator.participant);
  for (int i = 0; i < 100; ++i) forged->dispose(guid(1, navigator.participant->guid()));
  CHECK(navigator.finds("A/INavigator"));
  CHECK_FALSE(ground.finds("A/INavigator"));
  written = 0;
  pass(world, {&navigator, &ground}, 1000ms);
  CHECK(ground.finds("A/INavigator"));
  CHECK(written == 1);
}

TEST_CASE("what a peer has withdrawn does not come back by its own message that arrives late",
          "[R24]") {
  World world;
  Peer navigator(world, "navigator");
  auto registration =
      navigator.broker.add_service(navigator.describe(1, "A/INavigator", "navigator"));
  const auto description = navigator.broker.all().at(0);
  registration.withdraw();
  const auto late = world.services_writer(*navigator.participant);
  late->write(idl::encode_message(*description), {description->provider});
  CHECK_FALSE(navigator.finds("A/INavigator"));
}

TEST_CASE("a service that is withdrawn while it says that it is about to leave stays withdrawn",
          "[R10][R28]") {
  /// Runs `on_post` in the midst of what posts.
  struct Interrupting final : Executor {
    bool post(Action) override {
      if (on_post) std::exchange(on_post, nullptr)();
      return true;
    }
    void post_or_run(Action task) override { post(std::move(task)); }
    std::function<void()> on_post;
  };
  World world;
  Peer ground(world, "ground");
  Interrupting control;
  ProcessWatch watch;
  const auto participant = world.network.vendor()->create_participant({});
  Broker broker(*participant, world.clock, control, watch,
                {"uav-1", "navigator", "loopback", 1000ms});
  auto service = description(1, "A/INavigator", "navigator");
  service.provider = broker.new_provider().bytes;
  auto registration = broker.add_service(service);
  REQUIRE(ground.broker.all().size() == 1);

  const auto observation = broker.observe([](const Change&) {});
  control.on_post = [&] { registration.withdraw(); };
  broker.leave({service.provider});
  CHECK(broker.all().empty());
  CHECK(ground.broker.all().empty());
  CHECK(Peer(world, "late").broker.all().empty());
}

TEST_CASE("what found no room is asked for again when something goes", "[R26]") {
  World world;
  Peer ground(world, "ground");
  Writer crowd(world);
  auto one = crowd.describe(0, "A/ICrowd");
  for (std::size_t i = 0; i <= Room::kEntriesOfOne; ++i) {
    one.provider = guid(static_cast<std::uint8_t>(i), crowd.participant->guid()).bytes;
    one.provider[13] = static_cast<std::uint8_t>(i >> 8);
    one.entity = "crowd" + std::to_string(i);
    crowd.write(one);
  }
  CHECK(ground.broker.all().size() == Room::kEntriesOfOne);
  CHECK(ground.broker.refused(Refusal::NoRoom) == 1);
  CHECK_FALSE(ground.finds(one.entity));

  crowd.writer->dispose(guid(7, crowd.participant->guid()));
  pass(world, {&ground}, 20s);
  CHECK(ground.finds(one.entity));
  CHECK(ground.broker.all().size() == Room::kEntriesOfOne);
}

TEST_CASE("a description of more than it may be is refused, by its own peer at once", "[R25]") {
  World world;
  Peer ground(world, "ground");
  auto large = ground.describe(1, "A/ILarge", "ground");
  large.component = std::string(kMaxDescriptionBytes, ' ');
  CHECK_THROWS_WITH(ground.broker.add_service(large),
                    Catch::Contains("A/ILarge") && Catch::Contains("bytes"));
  Writer rogue(world);
  large.provider = guid(1, rogue.participant->guid()).bytes;
  large.process = "";
  rogue.write(large);
  CHECK(ground.broker.refused(Refusal::Oversized) == 1);
  CHECK(ground.broker.all().empty());
}

TEST_CASE("peers of another wire are logged once", "[R30]") {
  World world;
  Peer ground(world, "ground");
  const Writer later(world);
  const skein::test::Log log;
  for (std::uint8_t number = 1; number <= 2; ++number) {
    auto described = later.describe(number, "A/I");
    described.attributes = {{"skein:wire", "7"}};
    later.write(described);
  }
  CHECK(ground.broker.all().size() == 2);
  CHECK_FALSE(ground.finds("A/I"));
  CHECK(log.count("stranger (uav-1) runs a version of Skein whose wire is number 7") == 1);
}

TEST_CASE("a peer's own service has an identity that nobody else can have", "[R23]") {
  World world;
  Peer navigator(world, "navigator");
  Peer ground(world, "ground");
  auto described = navigator.describe(1, "A/I", "navigator");
  described.provider = ground.broker.new_provider().bytes;
  CHECK_THROWS_AS(navigator.broker.add_service(described), InvalidArgument);
  described.provider = navigator.broker.new_provider().bytes;
  CHECK_NOTHROW(navigator.broker.add_service(described));
  CHECK(navigator.broker.new_provider() != navigator.broker.new_provider());
}

TEST_CASE("observers hear of what comes and goes until they stop listening") {
  World world;
  Peer navigator(world, "navigator");
  Peer ground(world, "ground");
  std::vector<Change::Kind> kinds;
  auto observation =
      ground.broker.observe([&](const Change& change) { kinds.push_back(change.kind); });
  auto registration =
      navigator.broker.add_service(navigator.describe(1, "A/INavigator", "navigator"));
  registration.withdraw();
  ground.control.run_all();
  CHECK(kinds == std::vector{Change::Kind::Added, Change::Kind::Removed});

  observation.withdraw();
  const auto again =
      navigator.broker.add_service(navigator.describe(2, "A/INavigator", "navigator"));
  ground.control.run_all();
  CHECK(kinds.size() == 2);
}

TEST_CASE("an observer that lets itself go is not told of the changes that wait already") {
  World world;
  Peer ground(world, "ground");
  int told = 0;
  brokerless_discovery::Broker::Registration observation;
  observation = ground.broker.observe([&](const Change&) {
    ++told;
    observation.withdraw();
  });
  const auto one = ground.broker.add_service(ground.describe(1, "A/INavigator", "navigator"));
  const auto other = ground.broker.add_service(ground.describe(2, "A/INavigator", "navigator"));
  ground.control.run_all();
  CHECK(told == 1);
}

TEST_CASE("once an observer's registration has gone, no call of it is in progress") {
  World world;
  Peer ground(world, "ground");
  std::promise<void> called;
  std::promise<void> goes;
  std::atomic<bool> returned = false;
  auto observation = ground.broker.observe([&](const Change&) {
    called.set_value();
    goes.get_future().wait();
    for (int i = 0; i < 10'000; ++i) std::this_thread::yield();  // not sooner than it goes
    returned = true;
  });
  const auto service = ground.broker.add_service(ground.describe(1, "A/INavigator", "navigator"));
  std::thread control([&] { ground.control.run_all(); });
  called.get_future().wait();
  goes.set_value();
  observation.withdraw();
  CHECK(returned);
  control.join();
}

TEST_CASE("many changes at once are told by one task, all of them and in their order", "[R26]") {
  World world;
  Peer ground(world, "ground");
  std::vector<std::string> told;
  const auto observation = ground.broker.observe(
      [&](const Change& change) { told.push_back(change.description->service); });
  Writer crowd(world);
  std::vector<std::string> written;
  for (std::uint8_t i = 0; i < 100; ++i) {
    written.push_back("A/I" + std::to_string(i));
    crowd.write(crowd.describe(i, written.back()));
  }
  CHECK(ground.control.run_all() == 1);
  CHECK(told == written);
}

TEST_CASE("the table's generation stands while nothing changes, and grows with each change") {
  World world;
  Peer navigator(world, "navigator");
  Peer ground(world, "ground");
  const auto begin = ground.broker.generation();
  auto registration =
      navigator.broker.add_service(navigator.describe(1, "A/INavigator", "navigator"));
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
      navigator.broker.add_service(navigator.describe(1, "A/INavigator", "navigator"));
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

TEST_CASE("a provider of another version is asked for its types before a wait ends in vain",
          "[R9]") {
  World world;
  Peer navigator(world, "navigator");
  const auto provide = [&](std::uint8_t number, std::uint64_t version) {
    auto described = navigator.describe(number, "A/INavigator", "navigator");
    described.operations = {{"plan", 11, version}};
    return navigator.broker.add_service(described);
  };
  const auto other = provide(1, 1001);
  int asked = 0;
  std::function<void()> meanwhile;
  bool gave_up = false;
  Peer ground(world, "ground", "uav-1",
              [&](const ServiceDescription& provider, const Guid& participant, Instant,
                  const std::function<bool()>& gives_up) {
                ++asked;
                CHECK(provider.entity == "navigator");
                CHECK(participant == navigator.participant->guid().participant());
                CHECK_FALSE(gives_up());
                if (meanwhile) meanwhile();
                gave_up = gives_up();
                return std::shared_ptr<const types::TypeSystem>();
              });
  const OperationInfo wanted[] = {
      {"plan", 11, 1000, false, false, false, nullptr, nullptr, {}, ""}};
  const InterfaceInfo client{"A/INavigator", {}, wanted, ""};
  Query query = ground.broker.query("A/INavigator");
  query.client = &client;
  const auto await = [&] { return ground.broker.await_service(query, world.clock.now()).size(); };

  SECTION("if it tells nothing, the error says what the descriptions do") {
    CHECK_THROWS_WITH(await(), Catch::Contains("operation 'plan' has another signature there ("));
    CHECK(asked == 1);
    CHECK_FALSE(gave_up);
  }
  SECTION("nor does what goes wrong meanwhile take its place") {
    meanwhile = [] { throw Internal("no endpoint"); };
    CHECK_THROWS_WITH(await(), Catch::Contains("operation 'plan' has another signature there ("));
  }
  SECTION("those of one version are asked once") {
    const auto same = provide(2, 1001);
    CHECK_THROWS_AS(await(), Unavailable);
    CHECK(asked == 1);
  }
  SECTION("the right one that comes meanwhile is found") {
    Broker::Registration right;
    meanwhile = [&] { right = provide(3, 1000); };
    CHECK(await() == 1);
    CHECK(gave_up);
  }
  SECTION("nobody is asked if there is one") {
    const auto right = provide(4, 1000);
    CHECK(await() == 1);
    CHECK(asked == 0);
  }
  SECTION("nor by those who take any version") {
    query.client = nullptr;
    CHECK(await() == 1);
    CHECK(asked == 0);
  }
}

TEST_CASE("a malformed description is dropped and the others stand", "[R4]") {
  World world;
  Peer navigator(world, "navigator");
  Peer ground(world, "ground");
  const auto registration =
      navigator.broker.add_service(navigator.describe(1, "A/INavigator", "navigator"));
  const Writer stranger(world);
  const std::uint8_t truncated[] = {0, 1, 0, 0, 1, 2, 3};
  stranger.writer->write(std::as_bytes(std::span(truncated)),
                         guid(9, stranger.participant->guid()));
  CHECK(ground.broker.all().size() == 1);
  CHECK(ground.broker.refused(Refusal::Malformed) == 1);
}

namespace {

/// Keeps who hands it a task from returning, until it is told.
struct SlowToTake final : Executor {
  bool post(Action task) override {
    tasks.post(std::move(task));
    std::unique_lock lock(mutex);
    ++inside;
    changed.wait(lock, [&] { return open; });
    --inside;
    return true;
  }
  void post_or_run(Action task) override { post(std::move(task)); }
  bool let_in(bool now) {
    std::lock_guard lock(mutex);
    open = now;
    changed.notify_all();
    return inside > 0;
  }

  ManualExecutor tasks;
  std::mutex mutex;
  std::condition_variable changed;
  bool open = true;
  int inside = 0;
};

}  // namespace

TEST_CASE("a Broker's end leaves no endpoint to a timer's action that has not returned") {
  World world;
  SlowToTake control;
  ProcessWatch watch;
  const auto participant = world.network.vendor()->create_participant({});
  auto broker = std::make_unique<Broker>(*participant, world.clock, control, watch,
                                         Broker::Options{"uav-1", "navigator", "loopback", 1000ms});
  auto service = description(1, "A/INavigator", "navigator");
  service.provider = broker->new_provider().bytes;
  const auto registration = broker->add_service(service);
  const auto onlooker = world.network.vendor()->create_participant({});
  const auto reader =
      onlooker->create_reader({"skein/services", "skein::discovery::ServiceDescription", true}, {});
  REQUIRE(reader->matched_writers().size() == 1);

  control.let_in(false);
  std::thread timer([&] { world.clock.advance(250ms); });
  const bool held = eventually([&] { return control.let_in(false); });
  control.tasks.run_all();  // which sets the next timer
  std::thread end([&] { broker.reset(); });
  const bool gone = eventually([&] { return reader->matched_writers().empty(); });
  control.let_in(true);
  timer.join();
  end.join();
  CHECK(held);
  CHECK(gone);
}

namespace {

/// Its endpoints are made with delays and errors.
struct Hindered final : dds::Participant {
  explicit Hindered(World& world) : plain(world.network.vendor()->create_participant({})) {}
  std::unique_ptr<dds::Writer> create_writer(const dds::Topic& topic, const dds::Qos& qos,
                                             dds::WriterListener listener) override {
    if (before_writer) before_writer();
    return plain->create_writer(topic, qos, std::move(listener));
  }
  std::unique_ptr<dds::Reader> create_reader(const dds::Topic& topic, const dds::Qos& qos,
                                             dds::ReaderListener listener) override {
    if (before_reader) before_reader();
    return plain->create_reader(topic, qos, std::move(listener));
  }
  Guid guid() const override { return plain->guid(); }

  const std::unique_ptr<dds::Participant> plain;
  std::function<void()> before_writer;
  std::function<void()> before_reader;
};

}  // namespace

TEST_CASE("nothing is left of a service that could not be described to others") {
  World world;
  ManualExecutor control;
  ProcessWatch watch;
  Hindered participant(world);
  participant.before_writer = [] { throw Unavailable("no writer is left"); };
  Broker broker(participant, world.clock, control, watch,
                {"uav-1", "navigator", "loopback", 1000ms});
  auto service = description(1, "A/INavigator", "navigator");
  service.provider = broker.new_provider().bytes;
  CHECK_THROWS_AS(broker.add_service(service), Unavailable);
  CHECK(broker.all().empty());
  participant.before_writer = nullptr;
  const auto registration = broker.add_service(service);
  CHECK(broker.all().size() == 1);
}

TEST_CASE("the time that a Broker's first reader takes to be made is no sleep", "[R17]") {
  World world;
  ManualExecutor control;
  ProcessWatch watch;
  Hindered participant(world);
  participant.before_reader = [&] { world.clock.advance(600ms); };  // more than half a lease
  Broker broker(participant, world.clock, control, watch,
                {"uav-1", "navigator", "loopback", 1000ms});
  const Peer ground(world, "ground");
  auto service = description(1, "A/INavigator", "navigator");
  service.provider = broker.new_provider().bytes;
  const auto registration = broker.add_service(service);
  std::size_t written = 0;
  world.network.judge_transfers([&](const dds::Transfer& transfer) {
    written += transfer.topic == "skein/services";
    return dds::Fate::deliver();
  });
  world.clock.advance(250ms);
  REQUIRE(control.run_all() > 0);
  CHECK(written == 0);
  world.clock.advance(550ms);
  REQUIRE(control.run_all() > 0);
  CHECK(written > 0);
}

TEST_CASE("names that would not survive the wire are refused") {
  World world;
  CHECK_THROWS_AS(Peer(world, "two words"), InvalidArgument);
  CHECK_THROWS_AS(Peer(world, "*"), InvalidArgument);
  CHECK_THROWS_AS(Peer(world, "navigator", ""), InvalidArgument);
  CHECK_THROWS_AS(Peer(world, "wild[card]"), InvalidArgument);
}
