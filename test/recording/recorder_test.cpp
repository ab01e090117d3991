#include "recording/recorder.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <filesystem>
#include <thread>

#include "entity/entity_access.hpp"
#include "entity/inspection_topic.hpp"
#include "recording/mcap/reader.hpp"
#include "recording/player.hpp"
#include "recording/recorded_calls.hpp"
#include "recording/recorded_topic.hpp"
#include "recording/recorded_types.hpp"
#include "rpc/service/introspection_topic.hpp"
#include "skein/describe.hpp"
#include "skein/detail/codec.hpp"
#include "skein/dynamic.hpp"
#include "skein/entity.hpp"
#include "skein/error.hpp"
#include "skein/introspection.idl.hpp"
#include "test/dynamic/surveyor.hpp"
#include "test/tools/eventually.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;

namespace {

std::unique_ptr<Entity> make_entity(const std::string& name, const std::string& system = "uav-1") {
  EntityOptions options;
  options.name = name;
  options.system = system;
  options.vendor = dds::load_vendor("loopback");
  options.domain = 19;
  return std::make_unique<Entity>(std::move(options));
}

std::string new_file() {
  static int number = 0;
  const auto path =
      std::filesystem::temp_directory_path() / ("skein_recorder_test_" + std::to_string(getpid()) +
                                                "_" + std::to_string(++number) + ".mcap");
  std::filesystem::remove(path);
  return path;
}

/// A survey that is recorded; the file goes with it.
struct Recorded {
  std::unique_ptr<Entity> provider = make_entity("surveyor");
  std::unique_ptr<Entity> watcher = make_entity("recorder");
  std::string file = new_file();
  std::unique_ptr<recording::Recorder> recorder;

  Recorded() { provider->provide<survey::ISurveyor>(std::make_shared<Surveyor>()); }
  ~Recorded() { std::filesystem::remove(file); }

  void begin(recording::RecorderOptions options = {}) {
    recorder = std::make_unique<recording::Recorder>(*watcher, file, std::move(options));
  }

  std::uint64_t written(const std::string& topic) const {
    for (const auto& channel : recorder->statistics().channels) {
      if (channel.topic == topic) return channel.written;
    }
    return 0;
  }

  std::vector<recording::Message> messages_of(const recording::Reader& reader,
                                              const std::string& topic) const {
    std::vector<recording::Message> all;
    auto messages = reader.messages({.topics = {topic}});
    while (const auto message = messages.next()) {
      all.push_back(*message);
      all.back().data = {};
    }
    return all;
  }
};

/// A member that tells of many topics, and answers no other question.
class Mute {
 public:
  static constexpr int kTopics = 40;

 private:
  static bool answer(const inspection::Question& question, inspection::Answer& answer) {
    if (question.subject != inspection::Subject::Topics) return false;
    for (int i = 0; i < kTopics; ++i) {
      auto& topic = answer.topics.emplace_back();
      topic.name = "a" + std::to_string(i);  // before the others by name
      topic.type = "mute::Type";
      topic.systems = {"uav-1"};
      topic.publishes = true;
      topic.signature = 1;
    }
    return true;
  }

  static dds::ParticipantOptions options() {
    dds::ParticipantOptions options;
    options.domain = 19;
    return options;
  }

  std::unique_ptr<dds::Participant> participant_ =
      dds::load_vendor("loopback")->create_participant(options());
  ThreadExecutor control_{"mute", 1, 1000};
  introspection::Answerer answerer_{*participant_, control_, "uav-1/mute", answer};
};

/// As the publisher of a survey's type in the system uav-1 has it.
dds::Qos as_published(const QosPolicies& policies) {
  dds::Qos qos;
  static_cast<QosPolicies&>(qos) = policies;
  if (is_xcdr2(idl::type_support<survey::Marker>().representation))
    qos.representation = dds::DataRepresentation::Xcdr2;
  qos.partitions = {"uav-1"};
  return qos;
}

/// A foreign writer's disposal comes to each of its readers.
class Disposing final : public dds::Participant {
 public:
  std::unique_ptr<dds::Writer> create_writer(const dds::Topic&, const dds::Qos&,
                                             dds::WriterListener) override {
    throw Internal("nothing is written here");
  }
  std::unique_ptr<dds::Reader> create_reader(const dds::Topic&, const dds::Qos&,
                                             dds::ReaderListener listener) override {
    auto reader = std::make_unique<Reader>();
    listener.on_data(*reader);
    return reader;
  }
  Guid guid() const override { return {}; }

 private:
  class Reader final : public dds::Reader {
   public:
    std::size_t take(const std::function<void(const dds::Sample&)>& consumer,
                     std::size_t) override {
      dds::Sample end;
      end.state = dds::InstanceState::Disposed;
      consumer(end);
      return 1;
    }
    Guid guid() const override { return {}; }
    std::vector<Guid> matched_writers() const override { return {}; }
    dds::ReceiveCounters counters() const override { return {}; }
  };
};

std::vector<std::string> texts_of(const recording::Reader& reader, const std::string& topic) {
  std::vector<std::string> texts;
  auto messages = reader.messages({.topics = {topic}});
  while (const auto message = messages.next()) {
    texts.emplace_back(reinterpret_cast<const char*>(message->data.data()), message->data.size());
  }
  return texts;
}

template <class T>
std::vector<T> values_of(const recording::Reader& reader, const std::string& topic) {
  std::vector<T> values;
  auto messages = reader.messages({.topics = {topic}});
  while (const auto message = messages.next())
    values.push_back(idl::decode_message<T>(message->data));
  return values;
}

}  // namespace

TEST_CASE("the values of a topic are recorded as they travel, with their type") {
  Recorded recorded;
  auto publisher = recorded.provider->publisher<survey::Corner>("corner");
  recorded.begin();
  REQUIRE(eventually([&] { return !recorded.recorder->look(1s).empty(); }));
  REQUIRE(eventually([&] { return publisher.subscribers() == 1; }));
  for (int i = 0; i < 5; ++i) publisher.publish({double(i), 2});
  REQUIRE(eventually([&] { return recorded.written("corner") == 5; }));
  recorded.recorder->close();

  const recording::Reader reader(recorded.file);
  CHECK(reader.is_complete());
  const auto corners = values_of<survey::Corner>(reader, "corner");
  REQUIRE(corners.size() == 5);
  CHECK(corners[4].x == 4);
  const auto& channels = reader.channels();
  const auto channel =
      std::ranges::find(channels, "corner", [](const auto& each) { return each.second.topic; });
  REQUIRE(channel != channels.end());
  CHECK(channel->second.metadata.at("type") == "survey::Corner");
  CHECK(reader.schemas().at(channel->second.schema).encoding == "omgidl");
  CHECK_THAT(reader.attachment("idl/survey::Corner.idl").data, Catch::Contains("struct Corner"));
}

TEST_CASE("publishers that come later are heard, in another system and with less reliability") {
  Recorded recorded;
  auto early = recorded.provider->publisher<survey::Corner>("corner");
  recorded.begin();
  REQUIRE(eventually([&] {
    recorded.recorder->look(1s);
    return early.subscribers() == 1;
  }));
  TopicQos other;
  SECTION("of another system") { other.systems = {"uav-2"}; }
  SECTION("that are best effort") { other = TopicQos::sensor(10s); }
  auto late = recorded.provider->publisher<survey::Corner>("corner", other);
  REQUIRE(eventually([&] {
    recorded.recorder->look(1s);
    return late.subscribers() == 1 && early.subscribers() >= 1;
  }));
  early.publish({1, 1});
  late.publish({2, 2});
  CHECK(eventually([&] { return recorded.written("corner") == 2; }));
}

TEST_CASE("a publisher that several readers hear is recorded once") {
  Recorded recorded;
  TopicQos first;
  first.systems = {"uav-1"};
  TopicQos both;
  both.systems = {"uav-1", "uav-2"};
  const bool transient_local = GENERATE(false, true);
  first.transient_local = both.transient_local = transient_local;
  auto here = recorded.provider->publisher<survey::Corner>("corner", first);
  recorded.begin();
  REQUIRE(eventually([&] { return recorded.recorder->look(1s), here.subscribers() == 1; }));
  auto everywhere = recorded.provider->publisher<survey::Corner>("corner", both);
  REQUIRE(eventually([&] { return recorded.recorder->look(1s), everywhere.subscribers() == 2; }));
  for (int i = 0; i < 10; ++i) everywhere.publish({double(i), 1});
  here.publish({10, 1});
  REQUIRE(eventually([&] { return recorded.written("corner") >= 11; }));
  recorded.recorder->close();
  std::vector<double> seen;
  for (const auto& corner : values_of<survey::Corner>(recording::Reader(recorded.file), "corner")) {
    seen.push_back(corner.x);
  }
  CHECK(seen == std::vector<double>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10});
}

TEST_CASE("disposals of a keyed topic are recorded beside its values") {
  Recorded recorded;
  auto markers = recorded.provider->publisher<survey::Marker>("marker", TopicQos::state());
  auto corners = recorded.provider->publisher<survey::Corner>("corner");
  recorded.begin();
  REQUIRE(eventually([&] {
    return recorded.recorder->look(1s), markers.subscribers() == 1 && corners.subscribers() == 1;
  }));
  const survey::Marker north{"north", {1, 2}};
  markers.publish(north);
  markers.publish({"south", {3, 4}});
  markers.dispose(north);
  REQUIRE(eventually([&] { return recorded.written("skein/disposals") == 1; }));
  CHECK(recorded.written("marker") == 2);
  recorded.recorder->close();

  const recording::Reader reader(recorded.file);
  const auto disposals = texts_of(reader, "skein/disposals");
  REQUIRE(disposals.size() == 1);
  CHECK_THAT(disposals[0],
             Catch::StartsWith("{\"topic\":\"marker\",\"key\":\"" + key_hash(north).hex()));
  for (const auto& [id, channel] : reader.channels()) {
    if (channel.topic != "skein/disposals") continue;
    CHECK(channel.message_encoding == "json");
    CHECK(reader.schemas().at(channel.schema).encoding == "jsonschema");
  }
}

TEST_CASE("a disposal that came without its key is recorded without one") {
  Recorded recorded;
  auto markers = recorded.provider->publisher<survey::Marker>("marker", TopicQos::state());
  recorded.begin();
  REQUIRE(eventually([&] { return recorded.recorder->look(1s), markers.subscribers() == 1; }));
  const auto stranger = make_entity("stranger");
  const auto writer = EntityAccess::participant(*stranger).create_writer(
      {"marker", "survey::Marker", true}, as_published(TopicQos::state()));
  REQUIRE(eventually([&] { return !writer->matched_readers().empty(); }));
  writer->dispose({});
  REQUIRE(eventually([&] { return recorded.written("skein/disposals") == 1; }));
  recorded.recorder->close();
  const auto disposals = texts_of(recording::Reader(recorded.file), "skein/disposals");
  REQUIRE(disposals.size() == 1);
  CHECK_THAT(disposals[0],
             Catch::StartsWith("{\"topic\":\"marker\",\"writer\":\"" + writer->guid().hex()));
}

TEST_CASE("disposals are heard of keyed topics alone") {
  Disposing participant;
  for (const bool keyed : {true, false}) {
    CAPTURE(keyed);
    inspection::TopicEndpoint told;
    told.publishes = true;
    told.keyed = keyed;
    const KnownTopic topic{"marker", "survey::Marker", {{{}, "uav-1/stranger", told}}};
    int heard = 0;
    recording::RecordedTopic recorded([&](const dds::Sample&) { ++heard; });
    recorded.follow(participant, topic);
    CHECK(heard == (keyed ? 1 : 0));
  }
}

TEST_CASE("a topic that cannot be read beside another one is told, and ends no recording") {
  Recorded recorded;
  auto corners = recorded.provider->publisher<survey::Corner>("place");
  recorded.begin();
  REQUIRE(eventually([&] { return recorded.recorder->look(1s), corners.subscribers() == 1; }));
  auto other = make_entity("other", "uav-2");
  auto plots = other->publisher<survey::Plot>("place");
  std::string told;
  REQUIRE(eventually([&] {
    for (const std::string& news : recorded.recorder->look(1s)) told += news + "\n";
    return told.find("survey::Plot") != std::string::npos;
  }));
  CHECK_THAT(told, Catch::Contains("place (survey::Plot) is not recorded: "));
  CHECK(recorded.recorder->look(1s).empty());
  corners.publish({1, 2});
  CHECK(eventually([&] { return recorded.written("place") == 1; }));
}

TEST_CASE("a member that tells of topics and not of their types holds up no other topic") {
  Recorded recorded;
  const Mute mute;
  auto publisher = recorded.provider->publisher<survey::Corner>("corner", TopicQos::state());
  recorded.begin();
  std::atomic<bool> ended{false};
  std::jthread looking([&] {
    while (!ended) recorded.recorder->look(1s);
  });
  CHECK(eventually([&] { return publisher.subscribers() == 1; }, 5s));
  publisher.publish({1, 1});
  CHECK(eventually([&] { return recorded.written("corner") == 1; }));
  CHECK(
      eventually([&] { return recorded.recorder->statistics().channels.size() > Mute::kTopics; }));
  ended = true;
}

TEST_CASE("a recorder that is told to give up waits for nobody") {
  Recorded recorded;
  const Mute mute;
  recorded.begin({.gives_up = [] { return true; }});
  recorded.recorder->look(1h);
  recorded.recorder->close();
  CHECK(recording::Reader(recorded.file).is_complete());
}

TEST_CASE("calls are recorded with what they carried, whatever their transport and end") {
  Recorded recorded;
  const bool within_process = GENERATE(true, false);
  auto caller = make_entity("caller");
  recorded.begin();
  auto proxy = (within_process ? recorded.provider : caller)->connect<survey::ISurveyor>();
  REQUIRE(eventually([&] {
    proxy.greet("you");
    return recorded.recorder->look(1s), recorded.written("skein/call_records") > 0;
  }));
  std::int32_t corners = 0;
  CHECK_THROWS_AS(proxy.measure({}, corners), survey::NoPlot);
  for (const survey::Corner& corner : proxy.walk(3)) CHECK(corner.y == 0.5);
  REQUIRE(eventually([&] {
    return recorded.recorder->look(1s), recorded.written("calls/survey/ISurveyor/walk/reply") == 3;
  }));
  recorded.recorder->close();

  const recording::Reader reader(recorded.file);
  const auto records = values_of<introspection::CallRecord>(reader, "skein/call_records");
  const auto count = [&](introspection::CallEnd end, const std::string& operation) {
    return std::ranges::count_if(records, [&](const introspection::CallRecord& record) {
      return record.end == end && record.operation == operation;
    });
  };
  CHECK(count(introspection::CallEnd::Returned, "greet") >= 1);
  CHECK(count(introspection::CallEnd::Raised, "measure") == 1);
  CHECK(count(introspection::CallEnd::Item, "walk") == 3);
  CHECK(count(introspection::CallEnd::Returned, "walk") == 1);

  const auto requests = recorded.messages_of(reader, "calls/survey/ISurveyor/greet/request");
  const auto replies = recorded.messages_of(reader, "calls/survey/ISurveyor/greet/reply");
  REQUIRE_FALSE(requests.empty());
  REQUIRE(requests.size() == replies.size());
  CHECK(requests.front().sequence == replies.front().sequence);
  const auto raised =
      values_of<survey::NoPlot>(reader, "calls/survey/ISurveyor/measure/raised/survey::NoPlot");
  REQUIRE(raised.size() == 1);
  CHECK(raised.front().why == "it has no corner");
  for (const auto& [id, channel] : reader.channels()) {
    INFO(channel.topic);
    CHECK(channel.schema != 0);
  }
}

TEST_CASE("a call is recorded, however large, while no other one waits for its types") {
  const std::string file = new_file();
  recording::Writer writer(file);
  recording::RecordedTypes known(writer);
  const auto nobody_tells = [](const std::string&, const Guid&) -> types::TypeSystem {
    throw Unavailable("nobody tells types here");
  };
  const recording::RecordingTime time;
  recording::RecordedCalls calls(writer, known, time, nobody_tells, 1);
  introspection::CallRecord call;
  call.service = "survey/ISurveyor";
  call.operation = "measure";
  call.end = introspection::CallEnd::Returned;
  call.arguments.resize(64);
  const Bytes message = idl::encode_message(introspection::CallRecords{{call, call}, 0});
  dds::Sample sample;
  sample.cdr = message;
  calls.receive(sample);
  calls.name_channels();
  writer.close();
  const auto statistics = writer.statistics();
  std::filesystem::remove(file);
  const auto requests =
      std::ranges::find(statistics.channels, "calls/survey/ISurveyor/measure/request",
                        &recording::ChannelStatistics::topic);
  REQUIRE(requests != statistics.channels.end());
  CHECK(requests->written == 1);
  CHECK(statistics.dropped() == 1);  // the one that came while the first waited
}

TEST_CASE("a call of some MiB is recorded whole") {
  Recorded recorded;
  recorded.begin();
  auto proxy = recorded.provider->connect<survey::ISurveyor>();
  REQUIRE(eventually([&] {
    proxy.greet("you");
    return recorded.recorder->look(1s), recorded.written("skein/call_records") > 0;
  }));
  survey::Plot plot;
  plot.corners.resize(std::size_t{3} << 16);  // 3 MiB
  std::int32_t corners = 0;
  proxy.measure(plot, corners);
  const std::string topic = "calls/survey/ISurveyor/measure/request";
  REQUIRE(eventually([&] { return recorded.recorder->look(1s), recorded.written(topic) == 1; }));
  recorded.recorder->close();
  CHECK(recorded.recorder->statistics().dropped() == 0);
  const recording::Reader reader(recorded.file);
  auto messages = reader.messages({.topics = {topic}});
  const auto message = messages.next();
  REQUIRE(message);
  CHECK(message->data.size() > plot.corners.size() * sizeof(survey::Corner));
}

TEST_CASE("nothing of calls is copied while nobody records") {
  Recorded recorded;
  auto proxy = recorded.provider->connect<survey::ISurveyor>();
  CHECK(proxy.greet("you") == "Hello, you");
  recorded.begin({.introspection = false});
  CHECK(recorded.recorder->look(1s).empty());
  recorded.recorder->close();
  CHECK(recording::Reader(recorded.file).channels().empty());
}

TEST_CASE("of Skein's own topics those that are to be recorded have a channel") {
  Recorded recorded;
  recorded.begin();
  const auto channels = recorded.recorder->statistics().channels;
  introspection::for_each_topic([&](const introspection::AnyTopic& topic) {
    CAPTURE(topic.name);
    const auto count =
        std::ranges::count(channels, topic.name, &recording::ChannelStatistics::topic);
    const bool apart = topic.name == introspection::kTopic<introspection::CallRecords>.name;
    CHECK(count == (topic.recorded || apart ? 1 : 0));
  });
}

TEST_CASE("a replay publishes the recorded values again, in their order") {
  Recorded recorded;
  {
    auto publisher = recorded.provider->publisher<survey::Corner>("corner", TopicQos::state());
    publisher.publish({1, 1});
    recorded.begin();
    REQUIRE(
        eventually([&] { return recorded.recorder->look(1s), recorded.written("corner") == 1; }));
    for (int i = 2; i < 5; ++i) publisher.publish({double(i), 1});
    REQUIRE(eventually([&] { return recorded.written("corner") == 4; }));
    recorded.recorder->close();
  }
  std::mutex mutex;
  std::vector<double> seen;
  auto listener = make_entity("listener");
  auto subscription =
      listener->subscription<survey::Corner>("corner", {}, [&](const survey::Corner& corner) {
        std::lock_guard lock(mutex);
        seen.push_back(corner.x);
      });
  const recording::Reader reader(recorded.file);
  recording::Player player(*recorded.watcher, reader, {.rate = 100});
  CHECK(player.topics() == std::vector<std::string>{"corner"});
  REQUIRE(eventually([&] { return subscription.publishers() == 1; }));
  CHECK(player.play([](Duration) { return false; }) == 4);
  CHECK(eventually([&] {
    std::lock_guard lock(mutex);
    return seen == std::vector<double>{1, 2, 3, 4};
  }));
}

TEST_CASE("a replay is heard by those who demand a deadline and liveliness") {
  Recorded recorded;
  {
    auto helm = recorded.provider->publisher<survey::Corner>("command", TopicQos::command());
    recorded.begin();
    REQUIRE(eventually([&] { return recorded.recorder->look(1s), helm.subscribers() == 1; }));
    helm.publish({1, 1});
    REQUIRE(eventually([&] { return recorded.written("command") == 1; }));
    recorded.recorder->close();
  }
  auto vessel = make_entity("vessel");
  auto subscription = vessel->subscription<survey::Corner>("command", TopicQos::command());
  const recording::Reader reader(recorded.file);
  recording::Player player(*recorded.watcher, reader, {});
  REQUIRE(eventually([&] { return subscription.publishers() == 1; }));
  CHECK(player.play([](Duration) { return false; }) == 1);
  CHECK(eventually([&] { return subscription.take() == survey::Corner{1, 1}; }));
}

TEST_CASE("a replay keeps the recorded pace, faster or slower by its rate") {
  Recorded recorded;
  auto publisher = recorded.provider->publisher<survey::Corner>("corner");
  auto other = recorded.provider->publisher<survey::Corner>("other");
  {
    recording::Writer writer(recorded.file);
    recording::RecordedTypes types(writer);
    const auto known = describe(idl::type_support<survey::Corner>());
    const std::map<std::string, std::string> metadata{{"type", "survey::Corner"},
                                                      {"systems", "uav-1"}};
    const auto one = types.add_channel("corner", "survey::Corner", known, metadata);
    const auto two = types.add_channel("other", "survey::Corner", known, metadata);
    const Bytes value = idl::encode_message(survey::Corner{1, 2});
    constexpr std::uint64_t kHour = 3'600'000'000'000;
    writer.write({one, 1, 5 * kHour, 5 * kHour, value});
    writer.write({two, 2, 6 * kHour, 6 * kHour, value});
    writer.write({one, 3, 8 * kHour, 8 * kHour, value});
    writer.close();
  }
  const double rate = GENERATE(0.5, 1.0, 10.0);
  CAPTURE(rate);
  const recording::Reader reader(recorded.file);
  recording::Player player(*recorded.watcher, reader, {.rate = rate});
  std::vector<double> pauses;
  CHECK(player.play([&](Duration pause) {
    pauses.push_back(std::chrono::duration<double, std::ratio<3600>>(pause).count());
    return false;
  }) == 3);
  // From the first value on; this test waits for none of them.
  REQUIRE(pauses.size() == 3);
  CHECK(pauses[0] == Approx(0).margin(0.02));
  CHECK(pauses[1] == Approx(1 / rate).margin(0.02));
  CHECK(pauses[2] == Approx(3 / rate).margin(0.02));
}

TEST_CASE("a topic that is not recorded is refused with the one that was meant") {
  Recorded recorded;
  auto publisher = recorded.provider->publisher<survey::Corner>("corner", TopicQos::state());
  publisher.publish({1, 1});
  recorded.begin();
  REQUIRE(eventually([&] { return recorded.recorder->look(1s), recorded.written("corner") == 1; }));
  recorded.recorder->close();
  const recording::Reader reader(recorded.file);
  CHECK_THROWS_WITH(recording::Player(*recorded.watcher, reader, {.topics = {"cornr"}}),
                    Catch::Contains("did you mean 'corner'"));
}
