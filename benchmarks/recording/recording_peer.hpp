#pragma once

#include "skein/entity.hpp"

/// The processes of the benchmarks of recordings. Each obeys lines (harness/peer.hpp).
namespace skein::benchmarks {

/// Records all of its domain to a file that goes with it. `recorded TOPIC` answers how many
/// messages of the topic are in the file, `dropped` how many never will be, of all topics.
void record(const EntityOptions& options);

/// Subscribes to all topics of its domain and only counts, as they travel, what comes: `recorded
/// TOPIC` answers how many have.
void count(const EntityOptions& options);

/// Publishes on the topics `reliable` and `best_effort`. `subscribed` waits until both have a
/// subscriber. `publish TOPIC SIZE COUNT` answers in ns how long it took.
void publish(const EntityOptions& options);

}  // namespace skein::benchmarks
