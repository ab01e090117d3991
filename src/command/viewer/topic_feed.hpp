#pragma once

#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "dds/port/port.hpp"
#include "rpc/service/introspection_topic.hpp"
#include "skein/describe.hpp"
#include "skein/detail/type_support.hpp"
#include "skein/inspector.hpp"
#include "view/server.hpp"

namespace skein::command {

/// Finds the topics of a domain, and shows them as channels of a server. Each is read while
/// somebody watches its channel, and not before. Used by one thread.
class TopicFeed {
 public:
  /// All outlive it.
  TopicFeed(view::Server& server, dds::Participant& participant, Inspector& inspector);
  /// Closes the server, whose callbacks use what is here.
  ~TopicFeed();
  TopicFeed(const TopicFeed&) = delete;
  TopicFeed& operator=(const TopicFeed&) = delete;

  /// A topic of Skein's own, of all systems.
  template <class T>
  void show(const introspection::Topic<T>& topic) {
    add({topic.dds_topic(), topic.qos()}, topic.name, skein::describe(idl::type_support<T>()));
  }

  /// Asks all entities which topics they publish or read, shows these, and takes away those that
  /// none does any more. Waits up to 1 s for the answers, which it returns, and up to 2 s for the
  /// types of all that are new; a topic whose types are not told it leaves out the next time.
  std::vector<Inspected> update();

 private:
  struct Source {
    dds::Topic topic;
    dds::Qos qos;
  };

  /// What clients tell topics apart by.
  struct Key {
    std::string system;
    std::string name;
    std::string type;
    auto operator<=>(const Key&) const = default;  // NOLINT(modernize-use-nullptr): it has none
  };

  /// An endpoint on whose word a topic is read: a publisher's rather than a subscription's.
  struct Witness {
    Guid participant;
    inspection::TopicEndpoint endpoint;
  };

  struct Shown {
    std::uint64_t signature;
    view::ChannelId channel;  // 0: it cannot be shown
  };

  using Readers = std::map<view::ChannelId, std::unique_ptr<dds::Reader>>;

  using Witnesses = std::map<Key, Witness>;
  static Witnesses witnesses(const std::vector<Inspected>& entities);
  static Source source(const Key& key, const inspection::TopicEndpoint& endpoint);
  view::ChannelId add(Source source, const std::string& name, const types::TypeSystem& types);
  void add(const Key& key, const Witness& witness, const types::TypeSystem& types);
  void note_late(const Key& key);
  std::unique_ptr<dds::Reader> read(const Source& source, view::ChannelId channel);

  view::Server& server_;
  dds::Participant& participant_;
  Inspector& inspector_;
  std::map<Key, Shown> shown_;
  std::set<Key> late_;  // their types were not told the last time
  Readers readers_;     // used by the server's callbacks alone, until it is closed
};

/// Who publishes and reads these topics.
void add_topics(view::Graph& graph, const std::vector<Inspected>& entities);

}  // namespace skein::command
