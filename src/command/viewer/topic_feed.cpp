#include "topic_feed.hpp"

#include <chrono>
#include <utility>

#include "core/log.hpp"
#include "core/printable.hpp"
#include "core/wall_clock.hpp"
#include "recording/viewers/recording_idl.hpp"
#include "skein/error.hpp"

namespace skein::command {
namespace {

constexpr const char* kPlace = "view";
/// For the answers of all entities.
constexpr std::chrono::seconds kTopicsWithin{1};
constexpr std::chrono::seconds kTypesWithin{2};
constexpr std::size_t kLongestRefusal = 1024;
/// Of a topic, in a reader's queue, while its samples are handed over.
constexpr std::uint32_t kMaxWaiting = 1024;

std::string shown_name(const std::string& system, const std::string& topic) {
  return system + '/' + topic;
}

}  // namespace

TopicFeed::TopicFeed(view::Server& server, dds::Participant& participant, Inspector& inspector)
    : server_(server), participant_(participant), inspector_(inspector) {}

TopicFeed::~TopicFeed() { server_.close(); }

std::vector<Inspected> TopicFeed::update() {
  auto entities = inspector_.ask_all(inspection::Subject::Topics, kTopicsWithin);
  const auto now = witnesses(entities);
  std::erase_if(shown_, [&](const auto& each) {
    const auto found = now.find(each.first);
    if (found != now.end() && found->second.endpoint.signature == each.second.signature)
      return false;
    server_.remove_channel(each.second.channel);
    return true;
  });
  std::vector<const Witnesses::value_type*> asked;
  std::vector<Inspector::TypesWanted> wanted;
  for (const auto& each : now) {
    if (shown_.contains(each.first) || late_.contains(each.first)) continue;
    asked.push_back(&each);
    wanted.push_back({each.first.type, each.second.participant});
  }
  inspector_.types(wanted, kTypesWithin, [&](std::size_t index, const types::TypeSystem& told) {
    add(asked[index]->first, asked[index]->second, told);
  });
  late_.clear();
  for (const auto* each : asked)
    if (!shown_.contains(each->first)) note_late(each->first);
  return entities;
}

void TopicFeed::note_late(const Key& key) {
  late_.insert(key);
  log(LogLevel::Warning, kPlace,
      printable(key.name + ": nobody told the types of " + key.type, kLongestRefusal));
}

TopicFeed::Witnesses TopicFeed::witnesses(const std::vector<Inspected>& entities) {
  Witnesses result;
  for (const Inspected& entity : entities) {
    for (const auto& endpoint : entity.answer.topics) {
      for (const std::string& system : endpoint.systems) {
        const Key key{system, endpoint.name, endpoint.type};
        const auto [found, is_new] = result.try_emplace(key, Witness{entity.participant, endpoint});
        if (!is_new && endpoint.publishes && !found->second.endpoint.publishes) {
          found->second = {entity.participant, endpoint};
        }
      }
    }
  }
  return result;
}

// A reliable reader could slow its publishers down, so that only what is kept for late joiners is
// read reliably: otherwise it would not come.
TopicFeed::Source TopicFeed::source(const Key& key, const inspection::TopicEndpoint& endpoint) {
  Source result{{key.name, key.type, endpoint.keyed}, {}};
  result.qos.reliable = endpoint.transient_local && endpoint.reliable;
  result.qos.transient_local = result.qos.reliable;
  result.qos.max_waiting = kMaxWaiting;
  result.qos.exclusive = endpoint.exclusive;
  if (endpoint.xcdr2) result.qos.representation = dds::DataRepresentation::Xcdr2;
  result.qos.type.signature = endpoint.signature;
  result.qos.partitions = {key.system};
  return result;
}

void TopicFeed::add(const Key& key, const Witness& witness, const types::TypeSystem& types) {
  try {
    const auto channel =
        add(source(key, witness.endpoint), shown_name(key.system, key.name), types);
    shown_.emplace(key, Shown{witness.endpoint.signature, channel});
  } catch (const InvalidArgument& error) {  // IDL cannot say it, or what was told makes no sense
    shown_.emplace(key, Shown{witness.endpoint.signature, 0});
    log(LogLevel::Warning, kPlace,
        printable(key.name + " is not shown: " + error.what(), kLongestRefusal));
  }
}

view::ChannelId TopicFeed::add(Source source, const std::string& name,
                               const types::TypeSystem& types) {
  auto schema = recording::to_recording_idl(types, source.topic.type_name);
  view::Channel channel{name, std::move(schema.type), std::move(schema.text)};
  return server_.add_channel(std::move(channel),
                             [this, source = std::move(source)](view::ChannelId id, bool watched) {
                               readers_.erase(id);
                               if (watched) readers_.emplace(id, read(source, id));
                             });
}

std::unique_ptr<dds::Reader> TopicFeed::read(const Source& source, view::ChannelId channel) {
  dds::ReaderListener listener;
  listener.on_data = [this, channel](dds::Reader& reader) {
    reader.take([&](const dds::Sample& sample) {
      if (sample.state == dds::InstanceState::Alive) {
        server_.send(channel, nanoseconds_since_1970(), sample.cdr);
      }
    });
  };
  listener.on_incompatible = [](const dds::Incompatibility& why) {
    log(LogLevel::Warning, kPlace, printable(why.explanation, kLongestRefusal));
  };
  return participant_.create_reader(source.topic, source.qos, std::move(listener));
}

void add_topics(view::Graph& graph, const std::vector<Inspected>& entities) {
  for (const Inspected& entity : entities) {
    for (const auto& endpoint : entity.answer.topics) {
      auto& ends = endpoint.publishes ? graph.publishers : graph.subscribers;
      for (const std::string& system : endpoint.systems) {
        ends[shown_name(system, endpoint.name)].insert(entity.answer.entity);
      }
    }
  }
}

}  // namespace skein::command
