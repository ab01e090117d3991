#pragma once

#include <string>
#include <vector>

#include "profile/finding.hpp"
#include "profile/mission_profile.hpp"

namespace skein::launch {

/// Everything that a profile names and this machine does not have, as far as it concerns the peers
/// of `host` (see is_here()):
/// - network interfaces and CPUs
/// - hosts without an address that a peer would have to ask
/// - a peer without an interface in a mission of several hosts, where others could not meet it; a
///   peer that names no host there, which each launcher would start
/// Throws Internal where the system does not tell its interfaces.
std::vector<profile::Finding> check_machine(const profile::MissionProfile& mission,
                                            const std::string& host);

/// Warnings of hosts without an address that nobody here has to ask: there, names do not tell a
/// launcher where it is. May ask the network's name servers.
std::vector<profile::Finding> check_hosts(const profile::MissionProfile& mission,
                                          const std::string& host);

/// Plugins of those peers that cannot be opened, components that no plugin of theirs implements,
/// components for which no plugin is named, and selection strategies that neither their plugins nor
/// Skein hold. Loads the plugins into this process, for good.
std::vector<profile::Finding> check_plugins(const profile::MissionProfile& mission,
                                            const std::string& host);

}  // namespace skein::launch
