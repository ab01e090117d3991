#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "harness/child.hpp"

namespace skein::benchmarks {

inline constexpr std::array<const char*, 2> kVendors{"fastdds", "cyclonedds"};

/// A provider and a caller: how their processes are started. `skein fastdds-cyclonedds` is a Skein
/// provider on Fast DDS and a Skein client on Cyclone DDS; pairs of one vendor are `skein fastdds`.
struct Configuration {
  std::string name;
  std::vector<std::string> server;
  std::vector<std::string> client;
};

/// Where an entity of a configuration speaks, if not on loopback.
struct Place {
  std::string interface;
  std::string peer;
};

/// Each configuration gets a DDS domain of its own, so that none discovers another.
class Configurations {
 public:
  /// `program_folder` holds the benchmark's executables.
  explicit Configurations(std::string program_folder) : folder_(std::move(program_folder)) {}

  Configuration skein(const std::string& server, const std::string& client, std::size_t threads = 1,
                      const std::optional<Place>& server_place = {},
                      const std::optional<Place>& client_place = {});
  Configuration raw(const std::string& server, const std::string& client);
  Configuration unix_socket();

 private:
  std::string next_domain() { return std::to_string(++last_domain_); }

  std::string folder_;
  std::uint32_t last_domain_ = 30;
};

/// Both processes of a configuration, ready for calls.
struct Running {
  /// Starts the server, then the client; throws what Child throws.
  explicit Running(const Configuration& configuration, int server_network = -1,
                   int client_network = -1);

  /// `count` calls with `size_bytes` of content each way; microseconds.
  std::vector<double> call(std::size_t size_bytes, std::size_t count);

  Child server;
  Child client;
  /// From just before the client's process was made until its first reply.
  double first_reply_us = 0;
};

/// Both vendors paired with themselves and each other, provider first.
std::vector<std::pair<std::string, std::string>> vendor_pairs();

}  // namespace skein::benchmarks
