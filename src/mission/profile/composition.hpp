#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "mission/profile/mission_profile.hpp"

namespace skein::profile {

/// A service that a peer needs: its own dependency, or that of one of its CSPs.
struct Need {
  std::string interface;
  SourcePosition where;
  std::string csp;  ///< Empty for the peer's own.
};

/// Who provides what in a mission, for the checks that look at more than one peer.
class Composition {
 public:
  explicit Composition(const MissionProfile& mission);

  /// Numbers of the peers whose component implements the interface.
  const std::vector<std::size_t>& providers(const std::string& interface) const;
  /// What peer number `peer` needs of others; what its own CSPs implement is not among it.
  const std::vector<Need>& needs(std::size_t peer) const { return needs_[peer]; }
  /// A CSP that implements the interface, as `peer/csp`; empty if there is none.
  std::string csp_with(const std::string& interface) const;
  std::vector<std::string_view> public_interfaces() const;

  const MissionProfile& mission() const { return mission_; }

 private:
  void add_needs(const PeerProfile& peer);

  const MissionProfile& mission_;
  std::map<std::string, std::vector<std::size_t>> providers_;
  std::map<std::string, std::string> managed_;
  std::vector<std::vector<Need>> needs_;
};

/// The cycles among the peers' needs, each once, as numbers of peers in the order of the way round.
/// A peer is in a cycle if nothing it needs can be had without having the peer itself first; a need
/// that nobody provides is passed over here.
std::vector<std::vector<std::size_t>> dependency_cycles(const Composition& composition);

}  // namespace skein::profile
