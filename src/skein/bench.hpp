#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

/// `skein bench`: what a call costs here, on the user's own machine or between two hosts.
namespace skein::command::bench {

struct Arguments {
  std::string vendor = "cyclonedds";
  std::uint32_t domain = 99;
  std::string interface {};  ///< Empty: loopback.
  std::string peer{};        ///< The other host's address, with `interface`.
  std::vector<std::size_t> payloads{64, 1024, 65'536, 1'048'576};
  std::size_t count = 1000;
  std::size_t in_flight = 64;
  bool serve = false;   ///< Be the other side, until ended.
  bool remote = false;  ///< The other side runs already, elsewhere.
  std::string output{};
};

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
