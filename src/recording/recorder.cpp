#include "recording/recorder.hpp"

#include <algorithm>
#include <atomic>
#include <map>
#include <mutex>
#include <optional>
#include <utility>

#include "core/log.hpp"
#include "entity/entity_access.hpp"
#include "introspection/topic_witness.hpp"
#include "recording/mcap/format.hpp"
#include "recording/recorded_calls.hpp"
#include "recording/recorded_topic.hpp"
#include "recording/recorded_types.hpp"
#include "recording/recording_time.hpp"
#include "rpc/service/introspection_topic.hpp"
#include "skein/describe.hpp"
#include "skein/detail/json.hpp"
#include "skein/entity.hpp"
#include "skein/error.hpp"
#include "skein/inspector.hpp"
#include "skein/introspection.idl.hpp"

namespace skein::recording {
namespace {

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ",") + word;
  return text;
}

/// What a replay needs beside the type.
std::map<std::string, std::string> metadata_of(const KnownTopic& topic) {
  const TopicQos qos = topic.writing_qos();
  std::map<std::string, std::string> metadata{
      {"type", topic.type},
      {"systems", joined(topic.systems())},
      {"transient_local", qos.transient_local ? "true" : "false"},
      {"exclusive", qos.exclusive ? "true" : "false"},
      {"reliable", topic.reading_qos().reliable ? "true" : "false"}};
  if (qos.deadline) metadata["deadline_ms"] = std::to_string(qos.deadline->count());
  if (qos.liveliness_lease) metadata["lease_ms"] = std::to_string(qos.liveliness_lease->count());
  return metadata;
}

/// How often entities are asked for the types of a topic. What comes until they tell them has no
/// schema.
constexpr int kMostQuestions = 3;

/// MCAP has no message for the end of an instance, and a disposal no value of the topic's type.
constexpr const char* kDisposals = "skein/disposals";
constexpr const char* kDisposalSchema =
    R"({"title":"Disposal","type":"object","properties":{"topic":{"type":"string"},)"
    R"("key":{"type":"string","description":"The key's hash, DDSI-RTPS 9.6.3.8, in hexadecimal"},)"
    R"("writer":{"type":"string","description":"Its GUID, in hexadecimal"}}})";

std::string text_of_disposal(const std::string& topic, const dds::Sample& sample) {
  idl::JsonWriter json;
  json.begin_object();
  json.key("topic");
  json.write_string(topic);
  if (!sample.key.is_nil()) {  // foreign writers may send none
    json.key("key");
    json.write_string(sample.key.hex());
  }
  json.key("writer");
  json.write_string(sample.writer.hex());
  json.end_object();
  return json.take();
}

}  // namespace

struct Recorder::State {
  /// A topic that is recorded.
  struct Recorded {
    std::atomic<std::uint16_t> channel{0};
    bool has_schema = false;
    int questions = 0;                       // for its types
    std::string failure{};                   // why it is not read
    std::unique_ptr<RecordedTopic> topic{};  // last: its readers use the rest
  };

  State(Entity& entity_, const std::string& path, RecorderOptions options_)
      : entity(entity_),
        options(std::move(options_)),
        writer(path, options.writer),
        types(writer),
        inspector(entity, options.gives_up),
        calls(writer, types, time, [this](const std::string& service, const Guid& participant) {
          return inspector.types(service, participant, std::chrono::seconds(2));
        }) {
    if (!options.introspection) return;
    introspection::for_each_topic([this](const auto& topic) {
      if (topic.recorded) record_own(topic);
    });
    call_reader = std::make_unique<introspection::AnyReader>(
        EntityAccess::participant(entity), introspection::kTopic<introspection::CallRecords>,
        introspection::AnyReader::Listener{
            [this](const dds::Sample& sample) { calls.receive(sample); }});
  }

  /// One of Skein's own topics, as it travels.
  template <class T>
  void record_own(const introspection::Topic<T>& topic) {
    const std::string type = topic.type_name;
    const std::uint16_t channel =
        types.add_channel(topic.name, type, skein::describe(idl::type_support<T>()),
                          {{"type", type}, {"introspection", "true"}});
    own_readers.push_back(std::make_unique<introspection::AnyReader>(
        EntityAccess::participant(entity), topic,
        introspection::AnyReader::Listener{[this, channel](const dds::Sample& sample) {
          if (sample.state == dds::InstanceState::Alive) write(channel, sample.cdr);
        }}));
  }

  void write(std::uint16_t channel, std::span<const std::byte> cdr) {
    const std::uint64_t now = time.now();
    writer.write({channel, ++sequence, now, now, cdr});
  }

  bool is_wanted(const KnownTopic& topic) const {
    return options.topics.empty() || std::ranges::count(options.topics, topic.name) > 0;
  }

  Recorded& recorded_of(const KnownTopic& topic) { return recorded[{topic.name, topic.type}]; }

  /// Follows topics whose types are known, then those whose types come, as they come, and at last
  /// those without. Returns what it says of topics that are new, or of which there is news.
  std::vector<std::string> follow(const std::vector<KnownTopic>& topics, Duration patience) {
    std::vector<std::string> said;
    const auto follow_one = [&](const KnownTopic& topic) {
      if (auto news = follow(topic)) said.push_back(std::move(*news));
    };
    std::vector<const KnownTopic*> asked;
    std::vector<Inspector::TypesWanted> wanted;
    for (const KnownTopic& topic : topics) {
      Recorded& known = recorded_of(topic);
      if (known.has_schema || known.questions == kMostQuestions) {
        follow_one(topic);
        continue;
      }
      ++known.questions;
      asked.push_back(&topic);
      wanted.push_back({topic.type, witness_of(topic)});
    }
    inspector.types(wanted, patience, [&](std::size_t index, const types::TypeSystem& told) {
      name_channel(*asked[index], told);
      follow_one(*asked[index]);
    });
    for (const KnownTopic* topic : asked)
      if (!recorded_of(*topic).has_schema) follow_one(*topic);
    return said;
  }

  std::optional<std::string> follow(const KnownTopic& topic) {
    Recorded& known = recorded_of(topic);
    const bool is_new = !known.topic;
    const std::string name = topic.name + " (" + topic.type + ")";
    // What comes until somebody tells the types has no schema.
    if (known.channel == 0) known.channel = writer.add_channel(topic.name, 0, metadata_of(topic));
    if (topic.endpoints.front().told.keyed) name_disposals();
    const std::string failure = listen(known, topic);
    if (!failure.empty()) return name + " is not recorded: " + failure;
    if (!is_new) return std::nullopt;
    return known.has_schema ? name : name + ", without schema: nobody told its types yet";
  }

  void name_channel(const KnownTopic& topic, const types::TypeSystem& told) {
    Recorded& known = recorded_of(topic);
    try {
      known.channel = types.add_channel(topic.name, topic.type, told, metadata_of(topic));
      known.has_schema = true;
    } catch (const Error& error) {  // what was told makes no sense
      log(LogLevel::Warning, "recording", topic.name + ": " + error.what());
    }
  }

  void name_disposals() {
    if (disposals != 0) return;
    const auto schema = writer.add_schema("skein.Disposal", "jsonschema", kDisposalSchema);
    disposals = writer.add_channel(kDisposals, schema, {{"introspection", "true"}}, "json");
  }

  void write_sample(const Recorded& known, const std::string& topic, const dds::Sample& sample) {
    if (sample.state == dds::InstanceState::Alive) return write(known.channel, sample.cdr);
    const std::string text = text_of_disposal(topic, sample);
    write(disposals, std::as_bytes(std::span(text)));
  }

  /// Says why not, once for each reason. One topic must not end the recording of others.
  std::string listen(Recorded& known, const KnownTopic& topic) {
    if (!known.topic) {
      known.topic = std::make_unique<RecordedTopic>(
          [this, &known, name = topic.name](const dds::Sample& sample) {
            write_sample(known, name, sample);
          });
    }
    try {
      known.topic->follow(EntityAccess::participant(entity), topic);
      return "";
    } catch (const Error& error) {
      return std::exchange(known.failure, error.what()) == error.what() ? "" : error.what();
    }
  }

  void look_at_clock() {
    const ClockTimes now = clock_times_now();
    const auto step = time.step(now);
    if (!step) return;
    writer.add_metadata(
        {kClockStepName,
         {{"at_ns", std::to_string(time.at(now.since_boot))}, {"by_ns", std::to_string(*step)}}});
    log(LogLevel::Warning, "recording",
        "the wall clock was set by " + std::to_string(*step / 1'000'000'000) +
            " s; the recording's times go on from its start");
  }

  void end() {
    std::lock_guard lock(looking);
    look_at_clock();
    call_reader.reset();
    own_readers.clear();
    recorded.clear();
    calls.name_channels();
  }

  Entity& entity;
  const RecorderOptions options;
  RecordingTime time;
  Writer writer;
  RecordedTypes types;
  Inspector inspector;
  RecordedCalls calls;
  std::atomic<std::uint32_t> sequence{0};
  std::atomic<std::uint16_t> disposals{0};  // the channel, once a topic has keys
  std::mutex looking;                       // guards what follows
  std::map<std::pair<std::string, std::string>, Recorded> recorded;  // by name and type
  std::map<std::string, std::uint16_t> notes;                        // their channels, by topic
  // These go first: their listeners use the rest.
  std::vector<std::unique_ptr<introspection::AnyReader>> own_readers;
  std::unique_ptr<introspection::AnyReader> call_reader;
};

Recorder::Recorder(Entity& entity, const std::string& path, RecorderOptions options)
    : state_(std::make_unique<State>(entity, path, std::move(options))) {}

Recorder::~Recorder() {
  try {
    state_->end();
  } catch (const std::exception& error) {
    log(LogLevel::Error, "recording",
        std::string("what came last is not recorded: ") + error.what());
  }
}

std::vector<std::string> Recorder::look(Duration patience) {
  std::lock_guard lock(state_->looking);
  state_->look_at_clock();
  auto topics = known_topics(state_->inspector, patience);
  std::erase_if(topics, [&](const KnownTopic& topic) {
    return !state_->is_wanted(topic) || !topic.has_publisher();
  });
  auto said = state_->follow(topics, patience);
  state_->calls.name_channels();
  return said;
}

void Recorder::note(const std::string& topic, const std::string& json) {
  std::lock_guard lock(state_->looking);
  std::uint16_t& channel = state_->notes[topic];
  if (channel == 0) {
    const auto schema = state_->writer.add_schema(topic, "jsonschema", R"({"type":"object"})");
    channel = state_->writer.add_channel(topic, schema, {{"introspection", "true"}}, "json");
  }
  state_->write(channel, std::as_bytes(std::span(json)));
}

WriterStatistics Recorder::statistics() const { return state_->writer.statistics(); }

void Recorder::close() {
  state_->end();
  state_->writer.close();
}

}  // namespace skein::recording
