#include "skein/dynamic.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "entity/entity_access.hpp"
#include "entity/inspection_topic.hpp"
#include "skein/describe.hpp"
#include "skein/entity.hpp"
#include "skein/error.hpp"
#include "skein/inspector.hpp"
#include "surveyor.hpp"
#include "test/connector/pairing.hpp"
#include "test/tools/eventually.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;
using nlohmann::json;

namespace {

struct Survey {
  std::shared_ptr<Surveyor> surveyor = std::make_shared<Surveyor>();
  std::unique_ptr<Entity> provider = make_server("surveyor");
  std::unique_ptr<Entity> caller = make_client("caller");

  Survey() { provider->provide<survey::ISurveyor>(surveyor); }

  DynamicProxy connect(const std::string& name = "survey::ISurveyor") {
    return connect_dynamic(*caller, {.name = name});
  }
};

}  // namespace

TEST_CASE_METHOD(Survey, "a service is called without its IDL: arguments and results are JSON") {
  const DynamicProxy proxy = connect();
  CHECK(proxy.interface_name() == "survey/ISurveyor");

  const auto result = json::parse(
      proxy.call("measure", R"({"plot": {"kind": "Meadow", "corners": [{"x": 1, "y": 2}]}})"));
  CHECK(result == json::parse(R"({"return_": {"corners": [{"x": 1.0, "y": 2.0}], "area": 2.5,
                                              "owner": null}, "corners": 1})"));
  CHECK(proxy.call("greet", R"({"name": "you"})") == R"({"return_":"Hello, you"})");
  CHECK(proxy.async_call("greet", R"("you")").get() == R"({"return_":"Hello, you"})");
}

TEST_CASE_METHOD(Survey, "an example of an operation's arguments is taken as it stands") {
  const DynamicProxy proxy = connect();
  CHECK(proxy.example("measure") == R"({"plot":{"kind":"Meadow","corners":[]}})");
  CHECK(proxy.call("greet", proxy.example("greet")) == R"({"return_":"Hello, "})");
  CHECK(proxy.call("forget", proxy.example("forget")) == "{}");
}

TEST_CASE_METHOD(Survey, "one parameter may be given as its value alone, none as nothing") {
  const DynamicProxy proxy = connect();
  CHECK(proxy.call("greet", R"("you")") == R"({"return_":"Hello, you"})");
  CHECK(proxy.call("forget", "") == "{}");
  CHECK(eventually([&] { return surveyor->forgotten == 1; }));
}

TEST_CASE_METHOD(Survey, "a stream's results are JSON, one after the other") {
  std::vector<std::string> corners;
  for (const std::string& corner : connect().stream("walk", "3")) corners.push_back(corner);
  CHECK(corners == std::vector<std::string>{R"({"return_":{"x":0,"y":0.5}})",
                                            R"({"return_":{"x":1,"y":0.5}})",
                                            R"({"return_":{"x":2,"y":0.5}})"});
}

TEST_CASE_METHOD(Survey, "an exception that the interface declares is told by name and members") {
  const DynamicProxy proxy = connect();
  try {
    proxy.call("measure", R"({"plot": {"kind": "Wood", "corners": []}})");
    FAIL("it did not throw");
  } catch (const DynamicException& exception) {
    CHECK(exception.info().name == "survey::NoPlot");
    CHECK(json::parse(exception.json()) ==
          json::parse(R"({"why": "it has no corner", "kind": "Wood"})"));
    CHECK_THAT(exception.what(), Catch::Contains("survey::NoPlot") && Catch::Contains("no corner"));
  }
}

TEST_CASE_METHOD(
    Survey, "what does not fit is refused before it is sent, with the place and what was meant") {
  const DynamicProxy proxy = connect();
  const auto refused = [&](const char* operation, const char* arguments, const char* why) {
    CHECK_THROWS_WITH(proxy.call(operation, arguments), Catch::Contains(why));
  };
  refused("mesure", "{}", "did you mean 'measure'");
  refused("measure", R"({"plot": {"kind": "Medow", "corners": []}})", "Meadow");
  refused("measure", R"({"plot": {"kind": "Meadow", "corners": [{"x": 1}]}})",
          "$.plot.corners[0] lacks the member 'y'");
  refused("measure", R"({"plot": )", "this is no JSON");
  refused("greet", R"({"nam": "x"})",
          "$ has a member 'nam', which survey::ISurveyor::greet has not");
  refused("greet", R"({"nam": "x"})", "it lacks the member 'name'");
  refused("measure", R"({"plt": {}})", "$.plot has a member 'plt'");
  refused("measure", "", "this is no JSON");
  refused("walk", "3", "is a stream");
  CHECK_THROWS_AS(caller->connector().open(survey::ISurveyor::interface_info(),
                                           {.name = "Nobody", .timeout = 50ms}),
                  Unavailable);
}

TEST_CASE_METHOD(Survey, "the provider's types are the IDL that it was made of") {
  const std::string idl = to_idl(connect("surveyor").types());
  CHECK_THAT(idl, Catch::Contains("interface ISurveyor") && Catch::Contains("struct Plot") &&
                      Catch::Contains("exception NoPlot") && Catch::Contains("enum Kind"));
}

TEST_CASE_METHOD(Survey, "a provider that does not tell its types in time is named") {
  Inspector inspector(*caller);
  CHECK_THROWS_WITH(inspector.types("survey/INothing", provider->guid(), 50ms),
                    Catch::Contains("survey/INothing") && Catch::Contains("did not answer"));
}

TEST_CASE_METHOD(
    Survey,
    "entities tell what they are, which topics they have, and whom they have connected to") {
  auto publisher = provider->publisher<survey::Corner>("corner", TopicQos::state());
  auto subscription = provider->subscription<survey::Field>("field", TopicQos::sensor());
  auto proxy = provider->connect<survey::ISurveyor>();
  Inspector inspector(*caller);

  const auto peers = inspector.ask_all(inspection::Subject::Self, 5s);
  REQUIRE(peers.size() == 1);
  CHECK(peers[0].participant == provider->guid());
  CHECK(peers[0].answer.entity == provider->id());
  const auto& peer = peers[0].answer.peer.at(0);
  CHECK(peer.pid == static_cast<std::uint32_t>(getpid()));
  CHECK(peer.vendor == Pairing::get().server->name());
  CHECK(peer.services == 1);
  CHECK(peer.memory > 0);
  CHECK(peer.threads > 1);
  CHECK(peer.started < peer.time);

  const auto topics = inspector.ask_all(inspection::Subject::Topics, 5s).at(0).answer.topics;
  REQUIRE(topics.size() == 2);
  CHECK(topics[0].name == "corner");
  CHECK(topics[0].type == "survey::Corner");
  CHECK(topics[0].publishes);
  CHECK(topics[0].transient_local);
  CHECK(topics[1].name == "field");
  CHECK_FALSE(topics[1].publishes);
  CHECK_FALSE(topics[1].reliable);
  CHECK(inspector.types("survey::Corner", {}, 5s).declarations.size() == 1);

  const auto connections =
      inspector.ask_all(inspection::Subject::Connections, 5s).at(0).answer.connections;
  REQUIRE(connections.size() == 1);
  CHECK(connections[0].service == "survey/ISurveyor");
  CHECK(connections[0].transport == "process");
}

TEST_CASE_METHOD(Survey,
                 "who publishes as a topic's subscriptions demand is heard by all of them") {
  auto strict = provider->subscription<survey::Corner>("corner", TopicQos::command());
  Inspector inspector(*caller);
  std::vector<KnownTopic> topics;
  REQUIRE(eventually([&] {
    topics = known_topics(inspector, 5s);
    return !topics.empty();
  }));
  auto publisher = caller->publisher<survey::Corner>("corner", topics.front().writing_qos());
  CHECK(eventually([&] { return publisher.subscribers() == 1; }));
}

TEST_CASE_METHOD(Survey, "an answer by another one than who was asked does not count") {
  auto stranger = make_client("stranger");
  const auto answers = EntityAccess::participant(*stranger).create_writer(
      introspection::kAnswers.dds_topic(), introspection::kAnswers.qos());
  std::atomic<int> answered = 0;
  ThreadExecutor executor("stranger");
  const introspection::Reader<inspection::Question> questions(
      EntityAccess::participant(*stranger), introspection::kQuestions,
      [&](const inspection::Question& asked) {
        inspection::Answer answer;
        answer.asker = asked.asker;
        answer.number = asked.number;
        answer.types.emplace_back();
        executor.post([&, answer] {
          answers->write(idl::encode_message(answer));
          ++answered;
        });
      });
  Inspector inspector(*caller);
  CHECK_NOTHROW(inspector.types("survey/INothing", {}, 10s));  // of whoever knows them
  CHECK_THROWS_AS(inspector.types("survey/INothing", provider->guid(), 500ms), Unavailable);
  CHECK(answered >= 2);
  executor.stop();
}

TEST_CASE_METHOD(Survey, "topics that no vendor could read are not known, whoever tells of them") {
  auto stranger = make_client("stranger");
  const auto answers = EntityAccess::participant(*stranger).create_writer(
      introspection::kAnswers.dds_topic(), introspection::kAnswers.qos());
  const std::string too_long(256, 'a');
  const auto topic = [](const std::string& name, const std::string& type,
                        const std::string& system) {
    inspection::TopicEndpoint told;
    told.name = name;
    told.type = type;
    told.systems = {system};
    told.publishes = true;
    return told;
  };
  ThreadExecutor executor("stranger");
  const introspection::Reader<inspection::Question> questions(
      EntityAccess::participant(*stranger), introspection::kQuestions,
      [&](const inspection::Question& asked) {
        inspection::Answer answer;
        answer.asker = asked.asker;
        answer.number = asked.number;
        answer.topics = {topic(too_long, "T", "s"), topic("a", too_long, "s"),
                         topic("b", "T", too_long), topic("", "T", "s"),
                         topic("c", "", "s"),       topic("d", "T\x1b[2J", "s"),
                         topic("e", "T", "*"),      topic("sound", "T", "s")};
        executor.post([&, answer] { answers->write(idl::encode_message(answer)); });
      });
  Inspector inspector(*caller);
  std::vector<KnownTopic> topics;
  CHECK(eventually([&] {
    topics = known_topics(inspector, 1s);
    return !topics.empty();
  }));
  REQUIRE(topics.size() == 1);
  CHECK(topics.front().name == "sound");
  executor.stop();
}

TEST_CASE_METHOD(Survey, "what has gone is told no more") {
  Inspector inspector(*caller);
  {
    auto publisher = provider->publisher<survey::Corner>("corner");
    auto proxy = provider->connect<survey::ISurveyor>();
    CHECK(inspector.ask_all(inspection::Subject::Topics, 5s).at(0).answer.topics.size() == 1);
  }
  CHECK(inspector.ask_all(inspection::Subject::Topics, 5s).at(0).answer.topics.empty());
  CHECK(inspector.ask_all(inspection::Subject::Connections, 5s).at(0).answer.connections.empty());
}
