#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "harness/skipped.hpp"
#include "skein/clock.hpp"
#include "test/tools/child_process.hpp"

namespace skein::benchmarks {

/// A process of a measured configuration, which obeys lines on its standard input and answers with
/// lines on its standard output. It ends with this object, and with the process that made it.
class Child {
 public:
  static constexpr std::chrono::milliseconds kPatience{30'000};

  /// `network` is an open network namespace for the child, -1 for this process's own. Throws
  /// Skipped if the program does not exist.
  explicit Child(const std::vector<std::string>& command, int network = -1);
  Child(Child&& other) noexcept = default;
  Child& operator=(Child&&) = delete;
  /// Closes the child's input, at which it ends; kills it if it does not.
  ~Child();

  /// Just before the process was made; on the clock that all processes of a host share.
  Instant started() const noexcept { return started_; }

  void send(const std::string& line) { process_.send(line); }

  /// The next line, without its end. Throws Skipped if it says so (`skipped REASON`), and another
  /// exception if the child has ended, says `failed REASON`, or is silent for longer than
  /// `patience`.
  std::string receive(std::chrono::milliseconds patience = kPatience);

  /// SIGKILL, if it has not ended yet. Returns the instant just before.
  Instant kill();
  /// SIGSTOP or SIGCONT; after SIGSTOP it has stopped when this returns the instant just before.
  Instant signal(int number);

 private:
  std::string program_;
  Instant started_;
  test::ChildProcess process_;
};

}  // namespace skein::benchmarks
