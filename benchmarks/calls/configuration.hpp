#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "harness/child.hpp"

namespace skein::benchmarks {

inline constexpr std::array<const char*, 2> kVendors{"fastdds", "cyclonedds"};

/// A provider and a caller (or one process that is both: then `server` is empty): how their
/// processes are started. `skein fastdds-cyclonedds` is a Skein provider on Fast DDS and a Skein
/// client on Cyclone DDS; pairs of one vendor are `skein fastdds`.
struct Configuration {
  std::string name;
  std::vector<std::string> server;
  std::vector<std::string> client;
  /// Spins, so that it says nothing where both processes share a core.
  bool needs_a_core_each = false;
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
  /// Both on Fast DDS, with calls through shared memory.
  enum class SharedMemory {
    Sleeping,
    Spinning,  ///< Whoever waits spins before sleeping.
  };
  Configuration skein_same_host(SharedMemory how, std::size_t threads = 1);
  /// Of roles `viewer` and `lender` (calls/skein_peer.hpp).
  Configuration skein_lending();
  /// Records the domain of a Skein configuration.
  static std::vector<std::string> recorder_of(const Configuration& skein);
  /// A Skein publisher as `client`, and as `server` who receives: `recorder` or `counter`.
  Configuration skein_topic(const std::string& vendor, const std::string& receiver);
  Configuration raw(const std::string& server, const std::string& client);
  /// The vendor's own API in a way that differs from Skein's: `shared_memory`, `data_sharing`,
  /// `listener` or `polling`, as far as the vendor has it (raw/main.hpp).
  Configuration raw_by(const std::string& vendor, const std::string& way);
  /// One of `count` peers that find each other, each a process: a Skein entity with one service, a
  /// raw peer with the same endpoints, and a participant without any. Only `client` is set.
  Configuration skein_neighbour(const std::string& vendor, std::size_t count);
  Configuration raw_neighbour(const std::string& vendor, std::size_t count);
  Configuration bystander(const std::string& vendor, std::size_t count);
  /// Of the server at least `resident` octets are resident.
  Configuration unix_socket(std::uint64_t resident = 0);
  Configuration shared_memory();
  /// `rival` is `omniorb`, `grpc` or `zeromq`; transports are those of its peer's command line.
  Configuration rival(const std::string& rival, const std::string& transport);
  /// Caller and provider in one process, without DDS.
  Configuration skein_in_process();
  /// `transport` is `shortcut` for a POA whose calls within the process pass by the ORB.
  Configuration omniorb_in_process(const std::string& transport);
  /// A Head and its CSPs in one process; knows what perform_tasks() says.
  Configuration skein_head();
  /// Clients that know `bind COUNT` and `find COUNT`: of a Broker's table, and of omniORB's name
  /// server.
  Configuration skein_finder();
  Configuration name_server(const std::string& log_folder);

 private:
  Configuration skein_alone(const std::string& name, const std::string& role,
                            const std::string& vendor, std::size_t count);
  Configuration floor(const std::string& name, const std::string& program);
  std::string next_domain() { return std::to_string(++last_domain_); }

  std::string folder_;
  std::uint32_t last_domain_ = 30;
};

/// Where the two processes of a configuration run.
enum class Placement { Anywhere, OneCore, OneCoreEach };

/// The processes of a configuration, ready for calls.
struct Running {
  /// Starts the server, then the client; throws what Child throws.
  explicit Running(const Configuration& configuration, int server_network = -1,
                   int client_network = -1);

  /// `count` calls with `size_bytes` of content each way; microseconds.
  std::vector<double> call(std::size_t size_bytes, std::size_t count);
  /// What the client answers to any command whose answer are times; microseconds.
  std::vector<double> times(const std::string& command);
  /// Throws Skipped where there is but one core for OneCoreEach.
  void place(Placement placement);
  /// Processor time of both processes so far, microseconds.
  double cpu_us();

  std::optional<Child> server;
  Child client;
  /// From just before the client's process was made until its first reply.
  double first_reply_us = 0;
};

/// Processor time of one peer so far, microseconds.
double cpu_us_of(Child& child);

/// From `begin` to a time that a peer told (now_text()), microseconds.
double between_us(Instant begin, const std::string& end_ns);

/// The times that a peer answered with; microseconds.
std::vector<double> times_us(const std::string& answer);

/// `fastdds`, `fastdds-cyclonedds`.
std::string pair_name(const std::string& server, const std::string& client);

/// Both vendors paired with themselves and each other, provider first.
std::vector<std::pair<std::string, std::string>> vendor_pairs();

}  // namespace skein::benchmarks
