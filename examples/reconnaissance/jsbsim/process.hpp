#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace reconnaissance {

/// Where a program is: a name with a slash is its path, another one is looked for in PATH, and in
/// /usr/games, which is where Debian has JSBSim and what is not in everybody's PATH.
std::optional<std::filesystem::path> find_program(const std::string& name);

/// A file below the folder that JSBSim takes for its root.
struct RootFile {
  std::string name;
  std::string text;
};

/// JSBSim's stand-alone program in a process of its own, suspended after its first step. It reads
/// its files from a folder that goes with them (forget_files()), and has none of this process's
/// descriptors. The kernel kills it when the thread that made this object ends. Not thread-safe.
class JsbsimProcess {
 public:
  /// `script` is the name of one of the files. Throws JsbsimFailure where it cannot be started.
  JsbsimProcess(const std::filesystem::path& program, const std::vector<RootFile>& files,
                const std::string& script);
  /// Kills it.
  ~JsbsimProcess();
  JsbsimProcess(const JsbsimProcess&) = delete;
  JsbsimProcess& operator=(const JsbsimProcess&) = delete;

  pid_t pid() const noexcept { return pid_; }

  /// Whether it has not ended.
  bool runs();

  /// How it ended, or that it runs, with the last line that it wrote. It is given a moment to end:
  /// the kernel closes its connections before it can be waited for.
  std::string in_words();

  /// Once it has read its files.
  void forget_files();

 private:
  void start(const std::filesystem::path& program, const std::string& script);

  std::filesystem::path folder_;
  int output_ = -1;  // what it writes, in memory
  pid_t pid_ = -1;
  std::optional<int> status_;  // once it has ended
};

}  // namespace reconnaissance
