#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

#include "network_space.hpp"
#include "temporary_folder.hpp"

namespace skein::test {

/// A network namespace as a host that is reached by ssh: OpenSSH's server runs in it, with a folder
/// for its keys, and nothing of this machine's own configuration. It is that of the machine, or one
/// that `dev` has unpacked (build/ssh-server); it is installed by nobody.
class SshHost {
 public:
  /// Ends the program as skipped where there is no server, or where it may not be run. `prepare`, a
  /// shell command, may give the host files of its own: mounts are its alone.
  SshHost(const NetworkSpace& space, const std::string& address,
          const std::string& prepare = "true");
  /// Ends the server, and all that runs in the namespace.
  ~SshHost();
  SshHost(const SshHost&) = delete;
  SshHost& operator=(const SshHost&) = delete;

  /// A folder with the program `ssh` that knows this host, for the beginning of PATH. It may not be
  /// asked for a password.
  const std::filesystem::path& client_folder() const noexcept { return folder_.path(); }

  /// What runs in the namespace beside the server: the names of the programs.
  std::vector<std::string> programs() const;

 private:
  std::vector<pid_t> processes() const;

  TemporaryFolder folder_;
  ino_t space_ = 0;
};

}  // namespace skein::test
