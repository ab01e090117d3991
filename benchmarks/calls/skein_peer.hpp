#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "dds/port/port.hpp"
#include "skein/entity.hpp"

namespace skein::benchmarks {

/// One process of a Skein configuration.
struct SkeinPeer {
  std::string role;  ///< `server`, `client`, or `local`: both in one process; `finder`;
                     ///< `head`; `viewer`, `lender`; `neighbour`; `bystander`; or `recorder`,
                     ///< `publisher`, `counter`.
  std::string vendor;
  std::uint32_t domain = 0;
  std::size_t threads = 1;
  std::string interface;       ///< Empty: loopback.
  std::string peer;            ///< Address of the other host, with `interface`.
  bool shared_memory = false;  ///< See EntityOptions::shared_memory_calls.
  std::uint32_t spin_us = 0;   ///< See EntityOptions::spin.
  bool survives = false;       ///< A server or client that goes through faults: survive().
  std::size_t peers =
      0;  ///< Of a `neighbour` or `bystander`: how many there are, itself among them.
};

/// Those of a server or a client. Throws Skipped where its vendor is not installed.
EntityOptions entity_options(const SkeinPeer& peer);

/// Serves, or calls and obeys. Besides `call` a client knows `hold` (starts a call that does not
/// return; answers `holding` when the provider is at it) and `told` (waits for that call's end and
/// for the provider's description to go; answers with the times of both, in ns).
int run_skein_peer(const SkeinPeer& peer);

// What the roles do, each in a source of its own.

/// One of two peers that go through faults; both provide the service, so that each has something to
/// find again, and the one whose role is `client` calls the other. Every one knows `complete`
/// (waits until it knows both providers; answers with the time, in ns), the client also
///
/// | command | answer |
/// |---|---|
/// | `overdue COUNT` | `times`: of calls that nobody answers, from their deadline to their end |
/// | `answered` | calls until it has an answer: `answered` with the time, in ns |
void survive(const SkeinPeer& peer);

/// The peer that measures a Head and its CSPs, all in one process. Knows `bind COUNT` (so many CSPs
/// from now on), `direct COUNT` and `perform STRATEGY COUNT`, whose answers are `times`: of calls
/// of a CSP's operation by a proxy, on the calling thread, and of tasks that a session with that
/// strategy hands to the Head.
void perform_tasks();

/// Looks at what is lent to it, until its input ends.
void view(const SkeinPeer& peer);

/// Lends values of 1 MiB and 64 MiB to a peer that runs view(). Knows `lend_one COUNT`,
/// `lend_many COUNT`, and `copy_one COUNT`: so many copies of the same value by memcpy. Their
/// answers are `times`.
void lend(const SkeinPeer& peer);

/// Throws Skipped where it is not installed.
std::shared_ptr<dds::Vendor> load_or_skip(const std::string& vendor);

/// Provides a service and obeys, once it knows the services of all `peer.peers`.
void be_neighbour(const SkeinPeer& peer);

/// A participant of the port with no endpoint: obeys, once it knows all `peer.peers` participants.
void be_bystander(const SkeinPeer& peer);

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
