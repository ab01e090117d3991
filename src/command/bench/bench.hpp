#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "command/commands.hpp"
#include "skein/entity.hpp"

/// `skein bench`: what a call costs here, on the user's own machine or between two hosts.
namespace skein::command::bench {

/// One side of the measured calls: as the arguments say, or as the profile says of a peer.
struct Side {
  EntityOptions entity;
  ServiceOptions service;  ///< Of the provider.
  bool lock_memory = false;
};
enum class Role { Provider, Caller };

/// Throws profile::DescriptionError for a profile that cannot be read, InvalidArgument for a peer
/// that is not in it, for one that is alone (loopback), and for an address of another host where
/// nobody speaks beyond this one.
Side side_of(const BenchArguments& arguments, Role role);

/// `fastdds`, or `fastdds-cyclonedds`: the provider's vendor and the caller's. Throws what
/// side_of() throws of a profile; makes no thread.
std::string vendors_of(const BenchArguments& arguments);

/// Serves until SIGINT or SIGTERM, or until the process that started it ends.
void serve(const BenchArguments& arguments);

/// Rows of a result: `what`, `vendor`, `transport` (of ConnectionInfo), `payload_bytes` where it
/// has one, `samples`, `p50_us`, `p90_us`, `p99_us`.
using Rows = nlohmann::json;

/// One call after the other: each call's time.
Rows measure_latency(const BenchArguments& arguments);
/// With many calls in flight: the time per call of batches of so many.
Rows measure_throughput(const BenchArguments& arguments);
/// From the start of an entity until its first reply.
Rows measure_discovery(const BenchArguments& arguments);

}  // namespace skein::command::bench
