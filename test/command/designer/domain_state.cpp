// The state of a domain that the page of `skein designer` receives.
#include "command/designer/domain_state.hpp"

#include <catch2/catch.hpp>

#include "skein/discovery.idl.hpp"

using namespace skein;
using namespace skein::command;
using namespace skein::command::designer;
using Catch::Contains;

namespace {

constexpr std::uint64_t kSecond = 1'000'000'000;

Guid guid(std::uint8_t participant, std::uint8_t entity = 0) {
  Guid made;
  made.bytes[0] = participant;
  made.bytes[15] = entity;
  return made;
}

PeerPicture peer(const std::string& name, std::uint8_t number) {
  PeerPicture made;
  made.name = name;
  made.participant = guid(number);
  made.process.emplace().pid = number;
  return made;
}

void provide(PeerPicture& peer, const std::string& service, std::uint8_t provider,
             const std::string& owner = "", const std::string& csp = "") {
  discovery::ServiceDescription description;
  description.service = service;
  description.provider = guid(peer.participant.bytes[0], provider).bytes;
  description.owner = owner;
  description.entity = csp;
  peer.services.push_back(std::make_shared<const discovery::ServiceDescription>(description));
}

void add_topic(PeerPicture& peer, const std::string& topic, bool publishes,
               std::uint64_t samples = 0) {
  inspection::TopicEndpoint endpoint;
  endpoint.name = topic;
  endpoint.type = "geo::Pose";
  endpoint.publishes = publishes;
  endpoint.samples = samples;
  peer.topics.push_back(endpoint);
}

introspection::ServiceStatistics told(const Guid& provider, const std::string& service,
                                      const std::string& entity, std::uint64_t received) {
  introspection::ServiceStatistics statistics;
  statistics.provider = provider.bytes;
  statistics.service = service;
  statistics.entity = entity;
  statistics.system = "uav-1";
  introspection::OperationStatistics operation;
  operation.received = received;
  operation.ran.p50 = 10;
  operation.ran.p99 = 20;
  statistics.operations.push_back(operation);
  return statistics;
}

/// A client that has made so many calls to a navigator with a CSP in a process of its own and one
/// in its own process.
Observation mission(std::uint64_t calls = 0, std::uint64_t time = kSecond) {
  Observation sight;
  sight.time = time;
  sight.picture = {peer("uav-1/client", 1), peer("uav-1/navigator", 2),
                   peer("uav-1/navigator.AStar", 3)};
  provide(sight.picture[1], "AE/INavigator", 1);
  provide(sight.picture[2], "AE/IPlanner", 1, "uav-1/navigator", "AStar");
  sight.picture[0].connections.push_back(
      {"AE/INavigator", guid(2, 1).bytes, "shared memory", "", 0, calls});
  sight.picture[1].connections.push_back({"AE/IPlanner", guid(3, 1).bytes, "DDS", "", 0, calls});
  add_topic(sight.picture[1], "pose", true, 2 * calls);
  add_topic(sight.picture[0], "pose", false);
  sight.statistics = {told(guid(2, 1), "AE/INavigator", "navigator", calls),
                      told(guid(2, 2), "AE/IPlanner", "Straight", calls)};
  return sight;
}

launch::MissionStatus launcher_says(const std::string& process, const std::string& state,
                                    const std::string& reason = "") {
  launch::MissionStatus status;
  status.mission = "m";
  status.launcher = 99;
  launch::ProcessStatus told;
  told.name = process;
  told.system = "uav-1";
  told.state = state;
  told.reason = reason;
  status.processes.push_back(told);
  return status;
}

Plan plan() {
  return {"mission.xml",
          {{"uav-1/client", "uav-1", "client", {}, {"AE/INavigator", "AE/IWeather"}},
           {"uav-1/navigator",
            "uav-1",
            "navigator",
            {{"AE/INavigator", "", ""}, {"AE/IPlanner", "RRT", "navigator/RRT"}},
            {}},
           {"uav-1/weather", "uav-1", "weather", {{"AE/IWeather", "", ""}}, {}}}};
}

const EntityState& entity(const DomainState& state, const std::string& name) {
  for (const EntityState& each : state.entities)
    if (each.name == name) return each;
  FAIL("there is no " << name);
  throw 0;
}

}  // namespace

TEST_CASE("CSPs belong to their entity, in whichever process they are") {
  const DomainState state = StateMaker().make(mission());
  REQUIRE(state.entities.size() == 2);
  const auto& services = entity(state, "uav-1/navigator").services;
  REQUIRE(services.size() == 3);
  CHECK(services[0].name == "AE/INavigator");
  CHECK(services[0].csp.empty());
  CHECK(services[1].csp == "AStar");
  CHECK(services[1].pid == 3);
  CHECK(services[2].csp == "Straight");
  CHECK(services[2].pid == 0);
}

TEST_CASE("links go from entity to entity, with the rates of two sights, and without inner calls") {
  StateMaker maker;
  CHECK(maker.make(mission(100)).links.at(0).rate.empty());
  const DomainState state = maker.make(mission(300, 3 * kSecond));
  REQUIRE(state.links.size() == 2);
  CHECK(state.links[0].kind == LinkKind::Calls);
  CHECK(state.links[0].source == "uav-1/client");
  CHECK(state.links[0].target == "uav-1/navigator");
  CHECK(state.links[0].transport == "shared memory");
  CHECK(state.links[0].rate.front() == 100);
  CHECK(state.links[0].p99 == 20);
  CHECK(state.links[1].kind == LinkKind::Values);
  CHECK(state.links[1].name == "pose");
  CHECK(state.links[1].source == "uav-1/navigator");
  CHECK(state.links[1].rate.front() == 200);
}

TEST_CASE("a count that begins anew, as after a restart, is no rate") {
  StateMaker maker;
  maker.make(mission(100));
  CHECK(maker.make(mission(20, 2 * kSecond)).links.at(0).rate.empty());
}

TEST_CASE("who does not answer twice is silent; one late answer says nothing") {
  StateMaker maker;
  Observation sight = mission();
  sight.picture[1].process.reset();
  CHECK(entity(maker.make(sight), "uav-1/navigator").state == "ready");
  CHECK(entity(maker.make(sight), "uav-1/navigator").state == "silent");
}

TEST_CASE("who has gone is shown for a minute, with all that it had") {
  StateMaker maker;
  maker.make(mission());
  Observation sight = mission(0, 3 * kSecond);
  sight.picture.resize(1);
  const DomainState state = maker.make(sight);
  CHECK(entity(state, "uav-1/navigator").state == "gone");
  CHECK(entity(state, "uav-1/navigator").reason == "was last seen 2 s ago");
  CHECK(entity(state, "uav-1/navigator").services.size() == 3);
  sight.time += StateMaker::kRemembered;
  CHECK(maker.make(sight).entities.size() == 1);
}

TEST_CASE("a launcher says why a process is not there, and how to reach it") {
  Observation sight = mission();
  sight.missions = {launcher_says("navigator", "lost", "ended by signal 11"),
                    launcher_says("navigator/AStar", "waiting", "starts again in 1 s"),
                    launcher_says("radar", "starting", "for M/I")};
  const DomainState state = StateMaker().make(sight);
  const EntityState& navigator = entity(state, "uav-1/navigator");
  CHECK(navigator.state == "lost");
  CHECK(navigator.reason == "ended by signal 11");
  CHECK(navigator.process == "navigator");
  CHECK(navigator.launcher == 99);
  CHECK(navigator.services[1].state == "waiting");
  CHECK(navigator.services[1].process == "navigator/AStar");
  CHECK(entity(state, "uav-1/radar").state == "starting");
}

TEST_CASE("a process that runs and is not seen is missing, and hangs if it is stopped") {
  Observation sight = mission();
  sight.missions = {launcher_says("radar", "ready")};
  sight.missions[0].processes[0].pid = 7;
  StateMaker maker;
  CHECK(entity(maker.make(sight), "uav-1/radar").state == "missing");
  sight.stopped = {7};
  CHECK(entity(maker.make(sight), "uav-1/radar").state == "hangs");
}

TEST_CASE("a launcher's word is of its own system") {
  Observation sight = mission();
  sight.picture.push_back(peer("uav-2/navigator", 4));
  sight.missions = {launcher_says("navigator", "ready")};
  const DomainState state = StateMaker().make(sight);
  CHECK(entity(state, "uav-1/navigator").launcher == 99);
  CHECK(entity(state, "uav-2/navigator").launcher == 0);
}

TEST_CASE("who hangs keeps what it had, and its CSPs stay with it") {
  StateMaker maker;
  Observation sight = mission();
  sight.missions = {launcher_says("navigator", "ready")};
  sight.missions[0].processes[0].pid = 2;
  launch::ProcessStatus csp;
  csp.name = "navigator/AStar";
  csp.system = "uav-1";
  csp.state = "ready";
  sight.missions[0].processes.push_back(csp);
  maker.make(sight);
  sight.picture.erase(sight.picture.begin() + 1);  // given up by the others
  sight.picture[1].services.clear();               // whose owner has left the table
  sight.statistics.clear();
  sight.stopped = {2};
  sight.time += 2 * kSecond;
  const DomainState state = maker.make(sight);
  REQUIRE(state.entities.size() == 2);
  const EntityState& navigator = entity(state, "uav-1/navigator");
  CHECK(navigator.state == "hangs");
  REQUIRE(navigator.services.size() == 3);
  CHECK(navigator.services[1].csp == "AStar");
  CHECK(navigator.services[1].name == "AE/IPlanner");
}

TEST_CASE("when a mission has ended, its entities have, and nobody can be asked about them") {
  StateMaker maker;
  Observation sight = mission();
  sight.missions = {launcher_says("navigator", "ready")};
  maker.make(sight);
  sight.picture.clear();
  sight.statistics.clear();
  sight.missions[0].launcher = 0;
  sight.time += kSecond;
  const DomainState state = maker.make(sight);
  const EntityState& navigator = entity(state, "uav-1/navigator");
  CHECK(navigator.state == "ended");
  CHECK_THAT(navigator.reason, Contains("its mission has ended"));
  CHECK(navigator.process.empty());
  CHECK(navigator.services[0].state == "ended");
  CHECK(entity(state, "uav-1/client").state == "gone");
}

TEST_CASE("the plan is laid over what is there: missing and unplanned entities, CSPs and calls") {
  Observation sight = mission();
  sight.picture.push_back(peer("uav-1/stranger", 4));
  const DomainState state = StateMaker(plan()).make(sight);
  CHECK(entity(state, "uav-1/weather").state == "missing");
  CHECK(entity(state, "uav-1/stranger").state == "unplanned");
  CHECK(entity(state, "uav-1/client").state == "ready");
  const auto& services = entity(state, "uav-1/navigator").services;
  REQUIRE(services.size() == 4);
  CHECK(services[0].state == "ready");
  CHECK(services[1].csp == "AStar");
  CHECK(services[1].state == "unplanned");
  CHECK(services[2].csp == "RRT");
  CHECK(services[2].state == "missing");
  REQUIRE(state.links.size() == 3);
  CHECK(state.links[0].state == "ready");
  CHECK(state.links[2].name == "AE/IWeather");
  CHECK(state.links[2].target == "uav-1/weather");
  CHECK(state.links[2].state == "missing");
}

TEST_CASE("a dependency whose provider is there, and that is not called, is no fault") {
  Observation sight = mission();
  sight.picture.push_back(peer("uav-1/weather", 4));
  provide(sight.picture.back(), "AE/IWeather", 1);
  const DomainState state = StateMaker(plan()).make(sight);
  CHECK(state.links[2].name == "AE/IWeather");
  CHECK(state.links[2].state == "unused");
}

TEST_CASE("a CSP that a Head does not ask any more is quarantined, until it may be tried again") {
  Observation sight = mission();
  sight.wall_time = 3 * kSecond;
  introspection::Decision decision;
  decision.entity = "uav-1/navigator";
  decision.service = "AE/IPlanner";
  decision.time = 2 * kSecond;
  introspection::CandidateReport candidate;
  candidate.csp = "AStar";
  candidate.breaker = introspection::BreakerState::Open;
  candidate.quarantine = 5 * static_cast<std::int64_t>(kSecond);
  decision.candidates.push_back(candidate);
  sight.decisions = {decision};
  StateMaker maker;
  const DomainState state = maker.make(sight);
  const ServiceState& csp = entity(state, "uav-1/navigator").services[1];
  CHECK(csp.state == "quarantined");
  CHECK_THAT(csp.reason, Contains("tried again in 4 s"));
  sight.wall_time = 8 * kSecond;
  CHECK(entity(maker.make(sight), "uav-1/navigator").services[1].state == "ready");
}

TEST_CASE("a launcher's lines are of the entity that its process is") {
  launch::MissionLine line;
  line.system = "uav-1";
  line.process = "navigator/AStar";
  line.text = "hello";
  line.printed = true;
  CHECK(note_of(line, "m").entity == "uav-1/navigator.AStar");
  CHECK(note_of(line, "m").place == "printed");
  line.process = "navigator";
  CHECK(note_of(line, "m").entity == "uav-1/navigator");
  line.process = "";
  CHECK(note_of(line, "m").entity == "m");
}

TEST_CASE("what strangers call themselves is printable") {
  Observation sight;
  sight.picture = {peer("uav-1/\x1b[2J", 1)};
  CHECK(StateMaker().make(sight).entities.at(0).name == "uav-1/\\x1b[2J");
}
