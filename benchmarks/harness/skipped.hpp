#pragma once

#include <stdexcept>

namespace skein::benchmarks {

/// Thrown where something cannot be measured here and nobody is to blame: a vendor that is not
/// installed, a right that is missing. Its text is shown in the results.
class Skipped : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace skein::benchmarks
