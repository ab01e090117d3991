#include "topic_findings.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "core/suggestion.hpp"
#include "dds/port/compatibility.hpp"
#include "idl/types/type_difference.hpp"

namespace skein::command {
namespace {

using Endpoint = KnownTopic::Endpoint;

bool share_system(const inspection::TopicEndpoint& a, const inspection::TopicEndpoint& b) {
  return a.systems == b.systems ||
         std::ranges::find_first_of(a.systems, b.systems) != a.systems.end();
}

std::optional<std::chrono::milliseconds> time_of(const std::vector<std::uint64_t>& told) {
  if (told.empty()) return std::nullopt;
  return std::chrono::duration_cast<std::chrono::milliseconds>(
      std::chrono::nanoseconds(told.front()));
}

dds::Qos qos_of(const inspection::TopicEndpoint& told) {
  dds::Qos qos;
  qos.reliable = told.reliable;
  qos.transient_local = told.transient_local;
  qos.exclusive = told.exclusive;
  qos.deadline = time_of(told.deadline);
  qos.liveliness_lease = time_of(told.lease);
  return qos;
}

std::string others_versions(const Endpoint& publisher, const Endpoint& subscription,
                            const std::optional<idl::TypeDifference>& difference) {
  return publisher.entity + ", which publishes, and " + subscription.entity +
         ", which subscribes, have different versions of " + publisher.told.type +
         (difference ? ", which differ in " + difference->place : std::string()) +
         ", and do not hear each other: build both from the same IDL" +
         (difference ? "" : "; their logs say how the versions differ");
}

/// Asks each entity once about a type.
class Versions {
 public:
  explicit Versions(const TellTypes& tell) : tell_(tell) {}

  std::optional<idl::TypeDifference> difference(const Endpoint& one, const Endpoint& other) {
    const auto& here = types_of(one);
    const auto& there = types_of(other);
    return here && there ? idl::difference_of_types(*here, *there) : std::nullopt;
  }

 private:
  const std::optional<types::TypeSystem>& types_of(const Endpoint& endpoint) {
    const std::pair key(endpoint.participant, endpoint.told.type);
    const auto found = told_.find(key);
    if (found != told_.end()) return found->second;
    return told_.emplace(key, tell_ ? tell_(endpoint) : std::nullopt).first->second;
  }

  const TellTypes& tell_;
  std::map<std::pair<Guid, std::string>, std::optional<types::TypeSystem>> told_;
};

/// Empty where the two match. Two that have met somebody may be of one version each: types that
/// grow have several that match.
std::string conflict(const Endpoint& publisher, const Endpoint& subscription, Versions& versions) {
  const inspection::TopicEndpoint& offered = publisher.told;
  const inspection::TopicEndpoint& requested = subscription.told;
  const bool have_met = offered.matched > 0 && requested.matched > 0;
  if (offered.type != requested.type) {
    if (have_met) return {};
    return publisher.entity + " publishes " + offered.type + ", and " + subscription.entity +
           " subscribes to " + requested.type + ": they do not hear each other";
  }
  if (const auto why = dds::find_incompatibility(offered.name, subscription.participant,
                                                 qos_of(offered), qos_of(requested))) {
    return publisher.entity + ", which publishes, and " + subscription.entity +
           ", which subscribes, do not match in " + why->policy + ": the publisher offers " +
           why->offered + ", the subscription requests " + why->requested +
           "; give both the same profile";
  }
  if (have_met || offered.signature == 0 || requested.signature == 0) return {};
  const auto difference = versions.difference(publisher, subscription);
  if (!difference && offered.signature == requested.signature) return {};
  return others_versions(publisher, subscription, difference);
}

/// Skein's own topics, whose publishers come with what there is to tell.
bool is_own(const std::string& topic) { return topic.starts_with("skein/"); }

}  // namespace

std::vector<std::string> topic_conflicts(const std::vector<Endpoint>& endpoints,
                                         const TellTypes& tell_types) {
  Versions versions(tell_types);
  std::set<std::string> sentences;
  for (const Endpoint& publisher : endpoints) {
    if (!publisher.told.publishes) continue;
    for (const Endpoint& subscription : endpoints) {
      if (subscription.told.publishes || publisher.told.name != subscription.told.name) continue;
      if (!share_system(publisher.told, subscription.told)) continue;
      const std::string what = conflict(publisher, subscription, versions);
      if (!what.empty()) sentences.insert("topic '" + publisher.told.name + "': " + what);
    }
  }
  return {sentences.begin(), sentences.end()};
}

std::vector<UnpublishedTopic> unpublished_topics(const std::vector<Endpoint>& endpoints) {
  const auto meets = [&](const Endpoint& one, const Endpoint& other) {
    return one.told.publishes != other.told.publishes && one.told.name == other.told.name &&
           share_system(one.told, other.told);
  };
  const auto is_alone = [&](const Endpoint& one) {
    return std::ranges::none_of(endpoints, [&](const auto& other) { return meets(one, other); });
  };
  std::vector<UnpublishedTopic> found;
  std::set<std::pair<std::string, std::string>> told;  // topic and entity
  for (const Endpoint& subscription : endpoints) {
    const inspection::TopicEndpoint& wanted = subscription.told;
    if (wanted.publishes || is_own(wanted.name) || !is_alone(subscription)) continue;
    if (!told.emplace(wanted.name, subscription.entity).second) continue;
    std::vector<std::string> unheard;
    for (const Endpoint& other : endpoints) {
      if (other.told.publishes && share_system(other.told, wanted) && is_alone(other))
        unheard.push_back(other.told.name);
    }
    const std::string instead = suggestion(wanted.name, unheard);
    found.push_back({"topic '" + wanted.name + "' has no publisher" + instead + ": " +
                         subscription.entity + " subscribes to it",
                     !instead.empty()});
  }
  return found;
}

}  // namespace skein::command
