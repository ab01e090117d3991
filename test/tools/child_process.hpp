#pragma once

#include <sys/types.h>

#include <chrono>
#include <string>
#include <vector>

#include "eventually.hpp"

namespace skein::test {

/// A program beside the test's own in a process of its own, spoken with by lines. It never outlives
/// the test: the kernel kills it with the thread that started it. Not thread-safe.
class ChildProcess {
 public:
  struct Options {
    std::vector<std::string> arguments{};
    /// Further variables, `NAME=value`.
    std::vector<std::string> environment{};
    /// The network namespace that it lives in; -1 for the test's own.
    int network = -1;
    std::string directory{};  ///< Where it runs; empty for the test's own.
  };

  /// `program` is a path, from the folder of the test's own program if it is relative.
  ChildProcess(const std::string& program, const Options& options);
  /// Kills it, where nobody has yet, and waits for its end.
  ~ChildProcess();
  ChildProcess(ChildProcess&& other) noexcept;
  ChildProcess& operator=(ChildProcess&&) = delete;

  pid_t pid() const noexcept { return pid_; }

  void send(const std::string& line);

  /// Waits for the next line. Throws std::runtime_error that says what the child wrote before,
  /// where none comes in time.
  std::string read(std::chrono::steady_clock::duration patience = kPatience);

  /// The line that answers `command`.
  std::string ask(const std::string& command,
                  std::chrono::steady_clock::duration patience = kPatience) {
    send(command);
    return read(patience);
  }

  /// Waits for a line that starts with the word `first`; returns the rest. Throws as read() does,
  /// and for any other line.
  std::string expect(const std::string& first,
                     std::chrono::steady_clock::duration patience = kPatience);

  /// After SIGSTOP it has stopped when this returns.
  void signal(int number);

  /// All that it still writes, until it ends or closes its output.
  std::string read_all();

  /// Closes its input and waits: the exit code, or 128 and the signal that ended it.
  int finish();

  /// Closes its input; whether it ends in time.
  bool leaves(std::chrono::steady_clock::duration patience);

 private:
  void end_input();

  std::string program_;
  pid_t pid_ = -1;
  int in_ = -1;
  int out_ = -1;
  std::string unread_;
  std::string heard_;
};

}  // namespace skein::test
