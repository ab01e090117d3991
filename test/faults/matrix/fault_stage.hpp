#pragma once

#include <chrono>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "dds/port/port.hpp"
#include "test/faults/journal.hpp"
#include "test/tools/cable.hpp"
#include "test/tools/child_process.hpp"

namespace skein::test {

/// Where a peer lives: in the test's own network namespace, or at an end of a cable.
struct Place {
  const NetworkSpace* space = nullptr;
  std::string other_host{};
};

/// The processes of one cell of the fault matrix: providers and clients of the tally service, whose
/// calls one journal records.
class FaultStage {
 public:
  static constexpr std::chrono::milliseconds kLease{1000};
  /// So long that a silence is nobody's end, neither for the others nor for who was stopped.
  static constexpr std::chrono::milliseconds kLongLease{60'000};

  /// Its service is provided when this returns; `queue` requests may wait. Others trust it for
  /// `lease`.
  ChildProcess& add_server(const Place& place = {}, std::size_t queue = 4096,
                           std::chrono::milliseconds lease = kLease);
  /// A process with so many clients; they are connecting when this returns.
  ChildProcess& add_clients(int count, const Place& place = {},
                            std::chrono::milliseconds lease = kLease);
  /// Waits until all clients are connected, and each peer knows all providers.
  void connect();

  /// All clients of all processes call, each one call after the other.
  void start(const std::string& shape);
  /// Waits until more calls have been executed.
  void run_for_calls(int calls);
  void stop();

  /// A provider that is dead, and not waited for.
  void bury(ChildProcess& server);
  /// A process of clients that has left, or was killed: what it was calling then ended as "Killed".
  void bury_clients(ChildProcess& clients, bool killed);

  /// All tables know all living providers, and each client's calls succeed; then nothing is left
  /// behind: no pending call at a client, no active one at a provider, a session for each client
  /// and no more.
  void check_healed();
  /// What must be true again after every fault: check_healed(), and no thread that was not there in
  /// connect(). At last the journal is held to check_calls().
  void check(const std::string& cell, const std::set<std::string>& outcomes, int max_late = 0);

  Journal& journal() { return journal_; }
  ChildProcess& client(std::size_t index = 0) { return *clients_[index].process; }

 private:
  struct Clients {
    std::unique_ptr<ChildProcess> process;
    std::uint64_t number;
    int count;
  };
  std::unique_ptr<ChildProcess> make_peer(const std::string& name, const dds::Vendor& vendor,
                                          const Place& place, std::chrono::milliseconds lease);
  bool everybody_knows_all();
  bool nothing_left();
  std::vector<ChildProcess*> everybody();

  Journal journal_;
  std::uint64_t last_number_ = 0;
  std::vector<std::unique_ptr<ChildProcess>> servers_;
  std::vector<Clients> clients_;
  std::vector<std::pair<ChildProcess*, std::size_t>> threads_;
};

/// Two hosts at the ends of a cable: a provider on `here`, clients on `there`.
struct CableStage {
  NetworkSpace here;
  NetworkSpace there;
  Cable cable;
  FaultStage stage;
  ChildProcess& server;

  CableStage(std::uint64_t seed, int clients);
};

}  // namespace skein::test
