#pragma once

#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "eventually.hpp"
#include "temporary_folder.hpp"

namespace skein::test {

/// How a command is run.
struct CommandOptions {
  int network = -1;      ///< The network namespace that it runs in; -1 for the test's own.
  std::string output{};  ///< A file or device that takes its stdout; stderr stays here.
  std::function<void()> prepare{};  ///< Called in the new process; may make system calls only.
};

/// A run of the command `skein` beside the test, in a folder of its own that goes with this object.
/// The kernel ends it with the thread that started it. Not thread-safe.
class CommandRun {
 public:
  explicit CommandRun(const std::vector<std::string>& arguments,
                      const CommandOptions& options = {});
  ~CommandRun();
  CommandRun(const CommandRun&) = delete;
  CommandRun& operator=(const CommandRun&) = delete;

  pid_t pid() const noexcept { return pid_; }
  const std::filesystem::path& folder() const noexcept { return folder_.path(); }

  /// All that it and its processes have written until now.
  std::string output() const;
  /// Waits until it has written that.
  bool writes(const std::string& part, std::chrono::seconds limit = 3 * kPatience) const;
  void signal(int number) const;
  /// Waits for its end: the exit code, 128 + N for signal N; -1 where it does not end.
  int wait(std::chrono::seconds limit = 3 * kPatience);

 private:
  TemporaryFolder folder_;
  pid_t pid_ = -1;
  int exit_code_ = -1;
};

/// The commands of `skein` that have this option and take no argument, as their help says.
std::vector<std::string> commands_with(const std::string& option);

}  // namespace skein::test
