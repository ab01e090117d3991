#pragma once

#include <string>
#include <utility>
#include <vector>

namespace skein::profile {

/// The environment variable that names the pipe on which a process reports that it is ready.
inline constexpr const char* kReadyVariable = "SKEIN_READY_FD";

/// How the launcher starts a process.
struct ProcessStart {
  /// Looked for in PATH where it has no slash; empty for `skein peer`, which reads the profile.
  std::string program;
  bool tells_ready = true;     ///< False: it is taken for ready as soon as it runs.
  std::vector<unsigned> cpus;  ///< Where it may run at all; empty for anywhere.
  std::vector<std::pair<std::string, std::string>> environment;  ///< In addition; each name once.
  std::vector<std::string> arguments;
};

}  // namespace skein::profile
