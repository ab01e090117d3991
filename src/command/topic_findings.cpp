#include "type_conflicts.hpp"

#include <algorithm>
#include <set>

namespace skein::command {
namespace {

bool share_system(const inspection::TopicEndpoint& a, const inspection::TopicEndpoint& b) {
  return a.systems == b.systems ||
         std::ranges::find_first_of(a.systems, b.systems) != a.systems.end();
}

/// Two that have met somebody may be of one version each: types that grow have several that match.
bool conflict(const inspection::TopicEndpoint& publisher,
              const inspection::TopicEndpoint& subscription) {
  if (publisher.name != subscription.name || !share_system(publisher, subscription)) return false;
  if (publisher.matched > 0 && subscription.matched > 0) return false;
  if (publisher.type != subscription.type) return true;
  return publisher.signature != 0 && subscription.signature != 0 &&
         publisher.signature != subscription.signature;
}

std::string told(const KnownTopic::Endpoint& publisher, const KnownTopic::Endpoint& subscription) {
  const std::string& type = publisher.told.type;
  const std::string topic = "topic '" + publisher.told.name + "': ";
  if (type != subscription.told.type) {
    return topic + publisher.entity + " publishes " + type + ", and " + subscription.entity +
           " subscribes to " + subscription.told.type + ": they do not hear each other";
  }
  return topic + publisher.entity + ", which publishes, and " + subscription.entity +
         ", which subscribes, have different versions of " + type +
         ", and do not hear each other: build both from the same IDL; their logs say how the "
         "versions differ";
}

}  // namespace

std::vector<std::string> type_conflicts(const std::vector<KnownTopic::Endpoint>& endpoints) {
  std::set<std::string> sentences;
  for (const auto& publisher : endpoints) {
    if (!publisher.told.publishes) continue;
    for (const auto& subscription : endpoints) {
      if (!subscription.told.publishes && conflict(publisher.told, subscription.told))
        sentences.insert(told(publisher, subscription));
    }
  }
  return {sentences.begin(), sentences.end()};
}

}  // namespace skein::command
