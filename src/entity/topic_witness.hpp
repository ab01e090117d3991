#pragma once

#include <algorithm>

#include "skein/inspector.hpp"

namespace skein {

/// Whom to ask for a topic's types: one that publishes it, or else one that subscribes to it (the
/// other way round where not `publishes`), since the two sides may have different versions of a
/// type. Nil where nobody has the topic.
inline Guid witness_of(const KnownTopic& topic, bool publishes = true) {
  const auto found = std::ranges::find_if(
      topic.endpoints, [&](const auto& endpoint) { return endpoint.told.publishes == publishes; });
  if (found != topic.endpoints.end()) return found->participant;
  return topic.endpoints.empty() ? Guid{} : topic.endpoints.front().participant;
}

}  // namespace skein
