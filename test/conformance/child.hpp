#pragma once

#include <sys/types.h>

#include <cstdio>
#include <string>
#include <vector>

namespace skein::dds::conformance {

/// A child process of this test: a program beside the test's own, spoken with by lines.
class Child {
 public:
  /// `environment` holds further variables, "NAME=value"; `directory` is where it runs.
  Child(const std::string& program, std::vector<std::string> arguments,
        std::vector<std::string> environment = {}, const std::string& directory = ".");
  /// Kills it, if nobody has yet, and waits for its end.
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  void send(const std::string& line);
  /// The next line, waited for; empty at the end of the output.
  std::string read();
  void signal(int number);
  /// Stops it, and waits until it stands.
  void stop();
  /// Closes its input and returns its exit code.
  int finish();

 private:
  pid_t pid_ = -1;
  std::FILE* in_ = nullptr;
  std::FILE* out_ = nullptr;
};

}  // namespace skein::dds::conformance
