#pragma once

#include <string>

namespace skein::test {

/// A network namespace that the test made: its loopback device is up, and it goes when nobody uses
/// it any more.
class NetworkSpace {
 public:
  /// Ends the program as skipped where the test may not make one. The calling thread is in the
  /// namespace that it was in before.
  NetworkSpace();
  ~NetworkSpace();
  NetworkSpace(const NetworkSpace&) = delete;
  NetworkSpace& operator=(const NetworkSpace&) = delete;

  int descriptor() const noexcept { return descriptor_; }

  /// Runs a shell command in there; throws std::runtime_error where it fails.
  void run(const std::string& command) const;

 private:
  int descriptor_ = -1;
};

/// Moves the calling thread, and all that it starts, into a namespace while this lives.
class Inside {
 public:
  explicit Inside(const NetworkSpace& space);
  ~Inside();
  Inside(const Inside&) = delete;
  Inside& operator=(const Inside&) = delete;

 private:
  int before_;
};

}  // namespace skein::test
