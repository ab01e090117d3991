#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "skein/inspector.hpp"

// Why publishers and subscriptions of one another's topics do not hear each other. All functions
// take the endpoints of any number of topics.
namespace skein::command {

/// What an endpoint's entity tells of the endpoint's type; nothing where it does not answer.
using TellTypes = std::function<std::optional<types::TypeSystem>(const KnownTopic::Endpoint&)>;

/// Publishers and subscriptions of a topic that share a system and do not match, in their QoS or in
/// the type's name or version: a sentence for each two entities. `tell_types` is asked about those
/// of one type that have not met although nothing else keeps them apart.
std::vector<std::string> topic_conflicts(const std::vector<KnownTopic::Endpoint>& endpoints,
                                         const TellTypes& tell_types);

struct UnpublishedTopic {
  std::string sentence;
  bool misspelt = false;  ///< Another topic that nobody hears has almost the same name.
};

/// Topics that are subscribed to, and that nobody publishes in a system of the subscription.
std::vector<UnpublishedTopic> unpublished_topics(
    const std::vector<KnownTopic::Endpoint>& endpoints);

}  // namespace skein::command
