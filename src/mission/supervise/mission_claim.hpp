#pragma once

#include <sys/types.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mission/process/request_server.hpp"
#include "mission/profile/mission_profile.hpp"

namespace skein::launch {

/// How a launcher's answer begins.
inline constexpr std::string_view kAccepted = "ok ";
inline constexpr std::string_view kRefused = "no ";

/// Asks the launcher that flies this mission as that host one thing (see Supervisor) and gives its
/// answer. Throws Unavailable where no launcher of this user does, where it does not answer within
/// some seconds, and with its reason where it refuses.
std::string ask_launcher(const profile::MissionProfile& mission, const std::string& host,
                         const std::string& request);

/// The same, of the launcher that is this process: see MissionStatus::launcher.
std::string ask_launcher(pid_t launcher, const std::string& request);

struct LauncherAnswer {
  std::string text;
  std::string failure;  ///< Why there is none: it does not answer, or refuses.
  pid_t launcher = 0;
};

/// Asks all launchers of this user and network namespace at once, or those of a domain; those that
/// do not answer take some seconds together. Other users' sockets with such names cost no time.
std::vector<LauncherAnswer> ask_launchers(const std::string& request,
                                          std::optional<std::uint32_t> domain = {});

/// Keeps other launchers of this user and network namespace from flying the same mission (name,
/// domain and systems) as the same host, while it lives. Released with the process, however it
/// ends. At its socket, which is in the abstract namespace, requests to the launcher come in.
class MissionClaim {
 public:
  /// Throws InvalidArgument, which names the other launcher's process, where it is taken;
  /// Unavailable where the system refuses a socket. `host`: as for is_here().
  MissionClaim(const profile::MissionProfile& mission, const std::string& host);

  /// Listens at the claim's socket.
  RequestServer& requests() noexcept { return requests_; }

  /// The socket's name; empty if other users' processes have taken all names.
  const std::string& name() const noexcept { return name_; }

 private:
  RequestServer requests_;
  std::string name_;
};

/// The domain of the mission that the holder of a socket flies, by the socket's name as
/// /proc/net/unix shows it; nothing for another socket.
std::optional<std::uint32_t> claimed_domain(std::string_view socket);

}  // namespace skein::launch
