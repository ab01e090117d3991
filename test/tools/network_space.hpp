#pragma once

#include <string>

namespace skein::test {

/// A network namespace that the test made: its loopback device is up, and it goes when nobody uses
/// it any more.
class NetworkSpace {
 public:
  /// Calls `refused` if this process may not make one; by default this ends the program as skipped.
  /// The calling thread is in the namespace that it was in before.
  explicit NetworkSpace(void (*refused)() = skip);
  ~NetworkSpace();
  NetworkSpace(const NetworkSpace&) = delete;
  NetworkSpace& operator=(const NetworkSpace&) = delete;

  int descriptor() const noexcept { return descriptor_; }

  /// Runs a shell command in there; throws std::runtime_error where it fails.
  void run(const std::string& command) const;

 private:
  static void skip();

  int descriptor_ = -1;
};

/// Joins two by a pair of veth devices, `skein0` in each, with the addresses `subnet`.1 in `one`
/// and `subnet`.2 in `other`. Returns when both have a carrier: Fast DDS uses no device without.
void join(const NetworkSpace& one, const NetworkSpace& other, const std::string& subnet);

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
