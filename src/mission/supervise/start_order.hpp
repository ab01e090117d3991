#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "mission/profile/composition.hpp"

namespace skein::launch {

/// A service that a process waits for before the launcher starts it.
struct Prerequisite {
  std::string interface;
  std::vector<std::string> providers;  ///< Peers; one that is ready is enough.
};

/// In which order the peers of a mission are started on one host: each in a layer after those that
/// provide what it and its CSPs depend on. Of several providers the earliest counts. A service that
/// a peer of another host provides is not waited for here: the peer itself awaits it. MissionState
/// starts the peers by it.
class StartOrder {
 public:
  /// `is_here`: for each peer of the mission, whether it is started on this host.
  StartOrder(const profile::MissionProfile& mission, const std::vector<bool>& is_here);

  /// Of peer number `peer`, from 0. A cycle of dependencies, which a checked profile does not have,
  /// makes one last layer.
  std::size_t layer(std::size_t peer) const { return layers_[peer]; }
  /// What the process of a peer waits for: the peer's own dependencies and those of CSPs in its
  /// process; or, with `csp`, what that CSP's process waits for.
  std::vector<Prerequisite> prerequisites(std::size_t peer,
                                          const profile::CspProfile* csp = nullptr) const;

 private:
  bool waits_for(std::size_t peer, const profile::Need& need) const;

  const profile::MissionProfile& mission_;
  profile::Composition composition_;
  std::vector<bool> is_here_;
  std::vector<std::size_t> layers_;
};

}  // namespace skein::launch
