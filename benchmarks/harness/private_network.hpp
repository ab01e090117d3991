#pragma once

#include <optional>
#include <string>

#include "test/tools/network_space.hpp"

namespace skein::benchmarks {

/// Moves this process into a network of its own that has nothing but loopback, so that a run
/// neither disturbs others nor is disturbed; with a /dev/shm that vanishes with it, and with it
/// whatever a killed peer leaves there. Before any thread exists. Returns what stood in the way, or
/// "".
std::string enter_private_network();

/// Two hosts for this kernel: network namespaces with one cable (veth) between them. They vanish
/// with this object.
class TwoHosts {
 public:
  /// Throws Skipped if the kernel or the rights do not allow it or `ip` is not installed.
  TwoHosts();

  struct Host {
    int network = -1;
    std::string address;
  };
  Host first() const { return {first_->descriptor(), "10.77.0.1"}; }
  Host second() const { return {second_->descriptor(), "10.77.0.2"}; }

  /// From now on nothing arrives at the other end, and nobody is told: as when a link fails far
  /// away.
  void cut();
  void heal();

 private:
  std::optional<test::NetworkSpace> first_, second_;
};

}  // namespace skein::benchmarks
