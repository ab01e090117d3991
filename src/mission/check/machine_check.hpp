#pragma once

#include <string>
#include <vector>

#include "mission/profile/mission_profile.hpp"
#include "mission/xml/finding.hpp"

namespace skein::launch {

/// Everything that a profile names and this machine does not have, as far as it concerns the peers
/// of `host` (see is_here()):
/// - network interfaces, which must be up, too; CPUs, and programs of peers
/// - hosts without an address that a peer would have to ask
/// - a peer without an interface in a mission of several hosts, where others could not meet it; a
///   peer that names no host there, which each launcher would start
/// Throws Internal where the system does not tell its interfaces.
std::vector<profile::Finding> check_machine(const profile::MissionProfile& mission,
                                            const std::string& host);

/// Warnings of hosts without an address that nobody here has to ask: there, names do not tell a
/// launcher where it is. A note for each other host, of which nothing but the profile was checked.
/// May ask the network's name servers.
std::vector<profile::Finding> check_hosts(const profile::MissionProfile& mission,
                                          const std::string& host);

/// Vendors' modules and plugins of those peers that cannot be opened; plugins that every user may
/// replace, which are not opened; components that no plugin of theirs implements, or for which none
/// is named; interfaces that a component declares and its implementation lacks, or the other way
/// round; selection strategies that neither their plugins nor Skein hold. Components that could not
/// be read (null) are passed over. Notes say what was not checked: implementations whose
/// registration does not name their interface, and processes whose environment in the profile says
/// where libraries are. A process of its own loads the modules and plugins.
std::vector<profile::Finding> check_plugins(const profile::MissionProfile& mission,
                                            const std::string& host);

}  // namespace skein::launch
