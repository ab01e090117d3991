#pragma once

#include "brokerless_discovery/broker.hpp"
#include "mission/profile/mission_profile.hpp"
#include "skein/entity.hpp"

namespace skein::launch {

/// Kills the process of a CSP that hangs, so that the launcher starts it again. Only where it is
/// one that the profile gives this peer, with a process of its own on this host that is restarted
/// when it fails, and that process provides nothing to anybody else.
void end_hung_csp(Entity& entity, const profile::PeerProfile& peer, const Candidate& hung);

/// The same of a CSP whose lease has run out because its process is stopped. One that runs is left
/// alone: it was this process, perhaps, that did not.
void end_stopped_csp(Entity& entity, const profile::PeerProfile& peer,
                     const brokerless_discovery::Change& change);

}  // namespace skein::launch
