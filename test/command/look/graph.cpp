// What `skein graph` draws.
#include "command/look/graph.hpp"

#include <catch2/catch.hpp>

#include "command/doctor/encounter.hpp"
#include "command/look/topic_findings.hpp"
#include "skein/discovery.idl.hpp"

using namespace skein;
using namespace skein::command;
using Catch::Contains;

namespace {

Guid guid(std::uint8_t number) {
  Guid made;
  made.bytes[0] = number;
  return made;
}

/// A peer that answers.
PeerPicture peer(const std::string& name, std::uint8_t number) {
  PeerPicture made;
  made.name = name;
  made.participant = guid(number);
  made.process.emplace();
  return made;
}

void provide(PeerPicture& peer, const std::string& service, std::uint8_t provider,
             const std::string& owner = "", const std::string& entity = "") {
  discovery::ServiceDescription description;
  description.service = service;
  description.provider = guid(provider).bytes;
  description.owner = owner;
  description.entity = entity;
  peer.services.push_back(std::make_shared<const discovery::ServiceDescription>(description));
}

void publish(PeerPicture& peer, const std::string& topic, bool publishes) {
  inspection::TopicEndpoint endpoint;
  endpoint.name = topic;
  endpoint.type = "geo::Pose";
  endpoint.publishes = publishes;
  peer.topics.push_back(endpoint);
}

/// A client that calls a navigator with a CSP, and hears its pose.
DomainPicture mission() {
  DomainPicture picture{peer("gs/client", 1), peer("uav-1/navigator", 2)};
  provide(picture[1], "AE/INavigator", 10);
  provide(picture[1], "AE/IPlanner", 11, "uav-1/navigator", "AStar");
  picture[0].connections.push_back({"AE/INavigator", guid(10).bytes, "DDS", "", 0, 0});
  picture[0].connections.push_back({"AE/INavigator", guid(10).bytes, "DDS", "", 0, 0});
  publish(picture[1], "pose", true);
  return picture;
}

}  // namespace

TEST_CASE("a connection is an edge from the caller to the provider, however often there is one") {
  const Graph graph = graph_of(mission());
  REQUIRE(graph.nodes.size() == 3);
  CHECK(graph.nodes[1].system == "uav-1");
  CHECK(graph.nodes[1].label == "navigator\nAE/INavigator\nCSP AStar: AE/IPlanner");
  REQUIRE(graph.edges.size() == 2);
  CHECK(graph.edges[0].from == graph.nodes[0].id);
  CHECK(graph.edges[0].to == graph.nodes[1].id);
  CHECK(graph.edges[0].label == "AE/INavigator\nDDS");
}

TEST_CASE(
    "edges tell rates since an earlier picture, and how long the most called operation runs") {
  Traffic traffic;
  traffic.before = mission();
  traffic.seconds = 2;
  DomainPicture now = mission();
  now[0].connections[0].calls = 30;
  now[0].connections[1].calls = 10;
  now[1].topics[0].samples = 7;
  auto& service = traffic.services.emplace_back();
  service.provider = guid(10).bytes;
  service.operations.resize(2);
  service.operations[0].name = "plan";
  service.operations[0].ran = {9, 0, 2'500'000, 0, 40'000'000, 0};
  service.operations[1].name = "state";
  service.operations[1].ran.count = 3;
  const Graph graph = graph_of(now, traffic);
  CHECK(graph.edges[0].label == "AE/INavigator\nDDS, 20/s\nplan runs 2.5 ms, p99 40 ms");
  CHECK(graph.edges[1].label == "3.5/s");
}

TEST_CASE("a peer that was not there before has no rates") {
  Traffic traffic;
  traffic.seconds = 1;
  CHECK(graph_of(mission(), traffic).edges[0].label == "AE/INavigator\nDDS");
}

TEST_CASE("a topic joins its publishers and subscribers, of one system") {
  DomainPicture picture = mission();
  picture.push_back(peer("uav-1/payload", 3));
  publish(picture[2], "pose", false);
  publish(picture[0], "pose", false);
  const Graph graph = graph_of(picture);
  std::size_t topics = 0;
  for (const Graph::Node& node : graph.nodes) topics += node.topic ? 1 : 0;
  CHECK(topics == 2);
  picture[0].topics[0].systems = {"uav-1"};
  const Graph joined = graph_of(picture);
  topics = 0;
  for (const Graph::Node& node : joined.nodes) topics += node.topic ? 1 : 0;
  CHECK(topics == 1);
}

TEST_CASE("connections to those that nobody knows are left out") {
  DomainPicture picture = mission();
  picture[0].connections = {{"AE/IGone", guid(99).bytes, "DDS", "", 0, 0}};
  CHECK(graph_of(picture).edges.size() == 1);
}

TEST_CASE("a peer that does not answer is drawn as such") {
  DomainPicture picture = mission();
  picture[0].process.reset();
  CHECK_THAT(graph_of(picture).nodes[0].label, Contains("does not answer"));
}

TEST_CASE("each notation holds all nodes, edges and systems") {
  const Graph graph = graph_of(mission());
  const std::string dot = to_dot(graph);
  CHECK_THAT(dot, Contains("digraph skein {") && Contains("subgraph cluster_0 {") &&
                      Contains("label=\"uav-1\"") &&
                      Contains("p0 -> p1 [label=\"AE/INavigator\\nDDS\"]") &&
                      Contains("p1 -> t0;") && Contains("shape=ellipse"));
  const std::string mermaid = to_mermaid(graph);
  CHECK_THAT(mermaid, Contains("flowchart LR") && Contains("subgraph s0[\"gs\"]") &&
                          Contains("p0 -->|\"AE/INavigator<br>DDS\"| p1") &&
                          Contains("p1 --> t0") && Contains("t0([\"pose<br>geo::Pose\"])"));
  const auto json = to_json(graph);
  CHECK(json["nodes"].size() == 3);
  CHECK(json["edges"][0]["from"] == "p0");
}

TEST_CASE("names cannot break out of a notation") {
  DomainPicture picture{peer("a/\"];\n<b>&\\`", 1)};
  const Graph graph = graph_of(picture);
  CHECK_THAT(to_dot(graph), Contains(R"(label="\"];\\x0a<b>&\\`")"));
  CHECK_THAT(to_mermaid(graph), Contains(R"(["#quot;];\x0a#lt;b#gt;#amp;\#96;"])"));
}

TEST_CASE("the doctor tells of peers that answer to one name, once") {
  using namespace command::doctor;
  DomainPicture picture = mission();
  for (PeerPicture& each : picture) each.process->version = SKEIN_VERSION;
  picture.push_back(picture[0]);
  picture.back().process->pid = 4711;
  const auto symptoms = diagnose_peers(picture);
  REQUIRE(symptoms.size() == 1);
  CHECK_THAT(symptoms[0].cause, Contains("2 peers are called gs/client"));
  CHECK_THAT(symptoms[0].evidence, Contains("4711 on "));
  picture.back().process.reset();  // that one is told as one that does not answer
  CHECK_THAT(diagnose_peers(picture).at(0).cause, Contains("does not answer"));
}

TEST_CASE("the doctor tells of peers that do not answer, do not work, or are of another version") {
  using namespace command::doctor;
  DomainPicture picture = mission();
  for (PeerPicture& each : picture) each.process->version = SKEIN_VERSION;
  CHECK(diagnose_peers(picture).empty());
  picture[0].process->version = "9.9.9";
  CHECK_THAT(diagnose_peers(picture).at(0).cause, Contains("gs/client runs Skein 9.9.9"));
  picture[0].process->version = SKEIN_VERSION;
  picture[0].process->degraded = true;
  CHECK_THAT(diagnose_peers(picture).at(0).cause,
             Contains("CSPs of the peer gs/client do not return"));
  picture[0].process.reset();
  CHECK_THAT(diagnose_peers(picture).at(0).cause, Contains("does not answer"));
}

TEST_CASE("publishers and subscriptions whose types differ, and that have not met, are told") {
  using namespace command::doctor;
  DomainPicture picture = mission();
  for (PeerPicture& each : picture) each.process->version = SKEIN_VERSION;
  publish(picture[0], "pose", false);
  auto& subscription = picture[0].topics.back();
  auto& publisher = picture[1].topics.back();
  subscription.systems = publisher.systems = {"uav-1"};
  subscription.signature = publisher.signature = 7;
  CHECK(diagnose_peers(picture).empty());
  subscription.signature = 8;
  CHECK_THAT(diagnose_peers(picture).at(0).cause,
             Contains("topic 'pose': uav-1/navigator, which publishes, and gs/client, which "
                      "subscribes, have different versions of geo::Pose"));
  SECTION("in another system they are not meant to meet") {
    subscription.systems = {"gs"};
    const Symptoms symptoms = diagnose_peers(picture);
    REQUIRE(symptoms.size() == 1);
    CHECK(symptoms[0].severity == Severity::Note);
    CHECK(symptoms[0].cause == "topic 'pose' has no publisher: gs/client subscribes to it");
  }
  SECTION("versions that have met are of a type that grows") {
    subscription.matched = publisher.matched = 1;
    CHECK(diagnose_peers(picture).empty());
  }
  SECTION("a version that is not told is no other one") {
    subscription.signature = 0;
    CHECK(diagnose_peers(picture).empty());
  }
  SECTION("types of two names") {
    subscription.type = "geo::Fix";
    CHECK_THAT(diagnose_peers(picture).at(0).cause,
               Contains("uav-1/navigator publishes geo::Pose, and gs/client subscribes to "
                        "geo::Fix: they do not hear each other"));
  }
}

namespace {

types::TypeSystem pose_of(types::Kind kind, types::Extensibility extensibility) {
  types::Declaration pose;
  pose.name = "geo::Pose";
  pose.extensibility = extensibility;
  pose.members.resize(2);
  pose.members[0].name = "north";
  pose.members[0].type.kind = types::Kind::Double;
  pose.members[1].name = "height";
  pose.members[1].type.kind = kind;
  return {{pose}, {}};
}

}  // namespace

TEST_CASE("the doctor asks peers that have not met in what their versions of a type differ") {
  using namespace command::doctor;
  DomainPicture picture = mission();
  for (PeerPicture& each : picture) each.process->version = SKEIN_VERSION;
  publish(picture[0], "pose", false);
  picture[0].topics.back().signature = picture[1].topics.back().signature = 7;  // as they grow
  const TellTypes tell = [](const KnownTopic::Endpoint& asked) {
    return pose_of(asked.entity == "gs/client" ? types::Kind::Float : types::Kind::Double,
                   types::Extensibility::Appendable);
  };
  CHECK_THAT(diagnose_peers(picture, tell).at(0).cause,
             Contains("have different versions of geo::Pose, which differ in geo::Pose.height"));
  SECTION("who does not answer is not blamed") {
    CHECK(diagnose_peers(picture, [](const auto&) { return std::nullopt; }).empty());
  }
  SECTION("nor are those that have met") {
    picture[0].topics.back().matched = picture[1].topics.back().matched = 1;
    CHECK(diagnose_peers(picture, tell).empty());
  }
}

TEST_CASE("the doctor tells in what two providers of a service have different versions of it") {
  using namespace command::doctor;
  DomainPicture picture{peer("uav-1/new", 1), peer("uav-1/old", 2)};
  for (std::uint8_t i = 0; i < 2; ++i) {
    picture[i].process->version = SKEIN_VERSION;
    discovery::ServiceDescription description;
    description.service = "AE/INavigator";
    description.system = "uav-1";
    description.entity = picture[i].name.substr(6);
    description.operations = {{"plan", 11, 1000u + i}};
    if (i == 0) description.operations.push_back({"land", 12, 5});
    picture[i].services = {std::make_shared<const discovery::ServiceDescription>(description)};
  }
  const TellTypes tell = [](const KnownTopic::Endpoint& asked) {
    CHECK(asked.told.type == "AE/INavigator");
    types::Parameter from;
    from.name = "from";
    from.type.kind = asked.entity == "uav-1/new" ? types::Kind::Double : types::Kind::String;
    types::Operation plan;
    plan.name = "plan";
    plan.parameters = {from};
    types::Interface navigator;
    navigator.name = "AE::INavigator";
    navigator.operations = {plan};
    return types::TypeSystem{{}, {navigator}};
  };
  const std::string told =
      "service 'AE::INavigator': the providers at uav-1/new and at uav-1/old have different "
      "versions of it, and a client of one does not call the other";
  CHECK(diagnose_peers(picture, tell).at(0).cause ==
        told +
            ": operation 'plan': parameter 'from' is a double at uav-1/new and a string at "
            "uav-1/old");
  SECTION("also if one of them does not answer") {
    CHECK(diagnose_peers(picture, [](const auto&) { return std::nullopt; }).at(0).cause == told);
  }
  SECTION("more operations are no other version") {
    auto same = *picture[1].services[0];
    same.operations[0].signature = 1000;
    picture[1].services = {std::make_shared<const discovery::ServiceDescription>(same)};
    CHECK(diagnose_peers(picture, tell).empty());
  }
  SECTION("nor do those of two systems meet") {
    auto distant = *picture[1].services[0];
    distant.system = "uav-2";
    picture[1].services = {std::make_shared<const discovery::ServiceDescription>(distant)};
    CHECK(diagnose_peers(picture, tell).empty());
  }
}

TEST_CASE("QoS that keeps a publisher and a subscription apart is told with both values") {
  using namespace command::doctor;
  DomainPicture picture = mission();
  for (PeerPicture& each : picture) each.process->version = SKEIN_VERSION;
  publish(picture[0], "pose", false);
  auto& subscription = picture[0].topics.back();
  subscription.reliable = true;
  const Symptom told = diagnose_peers(picture).at(0);
  CHECK(told.severity == Severity::Warning);
  CHECK_THAT(told.cause,
             Contains("topic 'pose': uav-1/navigator, which publishes, and gs/client, which "
                      "subscribes, do not match in reliability: the publisher offers best effort, "
                      "the subscription requests reliable"));
  SECTION("periods") {
    subscription.reliable = false;
    subscription.deadline = {200'000'000};
    CHECK_THAT(diagnose_peers(picture).at(0).cause,
               Contains("deadline: the publisher offers none, the subscription requests 200 ms"));
  }
  SECTION("a publisher may offer more") {
    picture[1].topics.back().reliable = true;
    CHECK(diagnose_peers(picture).empty());
  }
}

TEST_CASE("a topic without a publisher is told, with the one that was meant") {
  using namespace command::doctor;
  DomainPicture picture = mission();
  for (PeerPicture& each : picture) each.process->version = SKEIN_VERSION;
  publish(picture[0], "psoe", false);
  const Symptom misspelt = diagnose_peers(picture).at(0);
  CHECK(misspelt.severity == Severity::Warning);
  CHECK(misspelt.cause ==
        "topic 'psoe' has no publisher (did you mean 'pose'?): gs/client subscribes to it");
  SECTION("a topic that somebody hears is not meant") {
    publish(picture[0], "pose", false);
    CHECK(diagnose_peers(picture).at(0).severity == Severity::Note);
  }
}
