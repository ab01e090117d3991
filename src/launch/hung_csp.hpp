#pragma once

#include "skein/entity/entity.hpp"
#include "skein/profile/mission_profile.hpp"

namespace skein::launch {

/// Kills the process of a CSP that hangs, so that the launcher starts it again. Only where it is
/// one that the profile gives this peer, with a process of its own on this host that is restarted
/// when it fails, and that process provides nothing to anybody else.
void end_hung_csp(Entity& entity, const profile::PeerProfile& peer, const Candidate& hung);

}  // namespace skein::launch
