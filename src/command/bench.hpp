#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "skein/entity.hpp"

/// `skein bench`: what a call costs here, on the user's own machine or between two hosts.
namespace skein::command::bench {

struct Arguments {
  std::string vendor = "cyclonedds";
  std::uint32_t domain = 99;
  std::string interface {};  ///< Empty: loopback.
  std::string peer{};        ///< The other host's address, where they speak on an interface.
  std::string
      profile{};  ///< A mission profile: vendor, interface and threads are those of its peers.
  std::string provider{};  ///< Its peer that is called; empty: its first.
  std::string caller{};    ///< Its peer that calls; empty: the provider.
  std::vector<std::size_t> payloads{64, 1024, 65'536, 1'048'576};
  std::size_t count = 1000;
  std::size_t in_flight = 64;
  bool serve = false;   ///< Be the other side, until ended.
  bool remote = false;  ///< The other side runs already, elsewhere.
  std::string output{};
};

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
Side side_of(const Arguments& arguments, Role role);

/// `fastdds`, or `fastdds-cyclonedds`: the provider's vendor and the caller's. Throws what
/// side_of() throws of a profile; makes no thread.
std::string vendors_of(const Arguments& arguments);

/// Serves until SIGINT or SIGTERM, or until the process that started it ends.
void serve(const Arguments& arguments);

/// Rows of a result: `what`, `vendor`, `payload_bytes` where it has one, `samples`, `p50_us`,
/// `p90_us`, `p99_us`.
using Rows = nlohmann::json;

/// One call after the other: each call's time.
Rows measure_latency(const Arguments& arguments);
/// With many calls in flight: the time per call of batches of so many.
Rows measure_throughput(const Arguments& arguments);
/// From the start of an entity until its first reply.
Rows measure_discovery(const Arguments& arguments);

/// Prints the rows that two saved results share, with the quotient of their medians. Throws
/// InvalidArgument where a file holds no result, or where they share none.
void compare(const std::string& before, const std::string& after);

}  // namespace skein::command::bench
