#pragma once

#include <functional>
#include <string>

#include "harness/skipped.hpp"

namespace skein::benchmarks {

/// Why something was not measured: nobody is to blame (skipped), or it should have been (failed).
/// Converts to true where it was not measured.
struct Absence {
  std::string reason{};
  bool failed = false;

  explicit operator bool() const noexcept { return !reason.empty(); }
};

/// Runs `measure`. What it throws becomes the result: skipped for Skipped, failed for the rest,
/// told on the standard error too, as `who`. So one contender's death costs its own figures and
/// nobody else's.
Absence attempt(const std::string& who, const std::function<void()>& measure);

/// The first where it speaks of a failure or the second is none, else the second: a failure is
/// never hidden.
const Absence& graver(const Absence& one, const Absence& other);

}  // namespace skein::benchmarks
