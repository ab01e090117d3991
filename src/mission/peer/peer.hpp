#pragma once

#include <string>

#include "mission/profile/mission_profile.hpp"
#include "skein/component_registry.hpp"
#include "skein/entity.hpp"

namespace skein::launch {

/// Where a peer speaks, and whom it listens to. One with an interface, but neither peers= nor
/// multicast, asks the hosts that other peers of the mission name.
dds::Network network_of(const profile::MissionProfile& mission, const profile::PeerProfile& peer);

/// How a peer joins its mission: vendor, domain, system, interface, shared memory, how long its
/// callers spin, and how its Head decides. Throws what dds::load_vendor throws.
EntityOptions entity_options(const profile::MissionProfile& mission,
                             const profile::PeerProfile& peer);

/// Runs one process of a mission as its profile says, from the implementations in `registry` and in
/// the plugins that the profile names: `navigator` for a peer with its in-process CSPs, whose Head
/// knows their selection strategies, `navigator/RRTstar` for a CSP with a process of its own. Joins
/// the mission, provides what the component implements, waits for what it depends on, passes the
/// implementation's self-test, reports ready and, if the profile asks for it, progress. A peer that
/// provides nothing then runs its activity or, with role="mission", its mission. Returns the exit
/// code: that of the activity or mission (kMissionFailed where it ends by an exception, which is
/// told on stderr); for others 0 when told to end by SIGTERM, SIGINT or SIGHUP. While it waits it
/// says for what, once a second has passed and whenever the reason changes.
///
/// Call it from main() before other threads exist: it blocks those signals for all that it starts.
/// Throws InvalidArgument for a name that the profile or the registry does not have, a strategy's
/// among them (with a suggestion), for a peer for which no code would run, and for one with a
/// program of its own; Unavailable where the
/// self-test fails, or a dependency does not appear within four fifths of the ready timeout: before
/// the launcher would end the process.
int run_process(const profile::MissionProfile& mission, const std::string& process,
                ComponentRegistry& registry);

}  // namespace skein::launch
