#pragma once

#include <string>

#include "profile/mission_profile.hpp"

namespace skein::launch {

/// Keeps other launchers of this user and network namespace from flying the same mission (name,
/// domain and systems) as the same host, while it lives. Released with the process, however it
/// ends.
class MissionClaim {
 public:
  /// Throws InvalidArgument, which names the other launcher's process, where it is taken;
  /// Unavailable where the system refuses a socket. `host`: as for is_here().
  MissionClaim(const profile::MissionProfile& mission, const std::string& host);
  ~MissionClaim();
  MissionClaim(const MissionClaim&) = delete;
  MissionClaim& operator=(const MissionClaim&) = delete;

 private:
  int socket_ = -1;
};

}  // namespace skein::launch
