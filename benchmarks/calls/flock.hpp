#pragma once

#include <list>

#include "calls/configuration.hpp"

namespace skein::benchmarks {

/// Many peers of one kind, a process each, that start at once and find each other.
class Flock {
 public:
  /// Returns when all see all. Throws what Child throws.
  Flock(const Configuration& neighbour, std::size_t count);
  /// Kills them.
  ~Flock();
  Flock(const Flock&) = delete;
  Flock& operator=(const Flock&) = delete;

  /// From just before the first process was made until the last peer saw all others.
  double joined_us() const noexcept { return joined_us_; }
  /// Processor time of all peers so far, microseconds.
  double cpu_us();

 private:
  void await(Child& peer);
  void end() noexcept;

  std::list<Child> peers_;
  double joined_us_ = 0;
};

}  // namespace skein::benchmarks
