#pragma once

#include "skein/inspector.hpp"

namespace skein {

/// Whom to ask for a topic's types: one that publishes it, or else one that subscribes to it (the
/// other way round where not `publishes`), since the two sides may have different versions of a
/// type. Who tells no version, as tools, has the types from others. Nil for anybody.
inline Guid witness_of(const KnownTopic& topic, bool publishes = true) {
  Guid witness;
  for (const auto& [participant, entity, told] : topic.endpoints) {
    if (told.signature == 0) continue;
    if (told.publishes == publishes) return participant;
    witness = participant;
  }
  return witness;
}

}  // namespace skein
