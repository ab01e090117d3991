#include <algorithm>
#include <set>

#include "skein/inspector.hpp"

namespace skein {
namespace {

std::optional<std::chrono::milliseconds> shorter(
    const std::optional<std::chrono::milliseconds>& known, const std::vector<std::uint64_t>& told) {
  if (told.empty()) return known;
  const auto time =
      std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::nanoseconds(told.front()));
  return known ? std::min(*known, time) : time;
}

KnownTopic& topic_of(std::vector<KnownTopic>& topics, const inspection::TopicEndpoint& endpoint) {
  for (KnownTopic& topic : topics) {
    if (topic.name == endpoint.name && topic.type == endpoint.type) return topic;
  }
  topics.push_back({endpoint.name, endpoint.type});
  return topics.back();
}

}  // namespace

std::vector<std::string> KnownTopic::systems() const {
  std::set<std::string> all;
  for (const Endpoint& endpoint : endpoints) {
    if (endpoint.told.systems.empty()) all.insert("");
    all.insert(endpoint.told.systems.begin(), endpoint.told.systems.end());
  }
  return {all.begin(), all.end()};
}

bool KnownTopic::has_publisher() const {
  return std::ranges::any_of(endpoints,
                             [](const Endpoint& endpoint) { return endpoint.told.publishes; });
}

TopicQos KnownTopic::reading_qos() const {
  TopicQos qos;
  qos.systems = systems();
  qos.reliable = qos.transient_local = has_publisher();
  for (const auto& [participant, entity, told] : endpoints) {
    if (!told.publishes) continue;
    qos.reliable &= told.reliable;
    qos.transient_local &= told.transient_local;
    qos.exclusive |= told.exclusive;
  }
  return qos;
}

TopicQos KnownTopic::writing_qos() const {
  TopicQos qos;
  qos.systems = systems();
  for (const auto& [participant, entity, told] : endpoints) {
    qos.deadline = shorter(qos.deadline, told.deadline);
    qos.liveliness_lease = shorter(qos.liveliness_lease, told.lease);
    qos.exclusive |= told.exclusive;
    qos.transient_local |= told.transient_local;
  }
  if (qos.transient_local) qos.history_depth = 1;
  return qos;
}

std::vector<KnownTopic> known_topics(Inspector& inspector, Duration timeout) {
  std::vector<KnownTopic> topics;
  for (const auto& [participant, answer] :
       inspector.ask_all(inspection::Subject::Topics, timeout)) {
    for (const inspection::TopicEndpoint& endpoint : answer.topics) {
      topic_of(topics, endpoint).endpoints.push_back({participant, answer.entity, endpoint});
    }
  }
  std::ranges::sort(topics, {},
                    [](const KnownTopic& topic) { return std::pair(topic.name, topic.type); });
  return topics;
}

}  // namespace skein
