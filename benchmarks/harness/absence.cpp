#include "harness/absence.hpp"

#include <cstdio>

namespace skein::benchmarks {

Absence attempt(const std::string& who, const std::function<void()>& measure) {
  try {
    measure();
    return {};
  } catch (const Skipped& reason) {
    return {reason.what(), false};
  } catch (const std::exception& error) {
    const std::string reason = *error.what() != '\0' ? error.what() : "an error without a text";
    std::fprintf(stderr, "\nfailed: %s: %s\n", who.c_str(), reason.c_str());
    return {reason, true};
  }
}

const Absence& graver(const Absence& one, const Absence& other) {
  if (!one) return other;
  return other.failed && !one.failed ? other : one;
}

}  // namespace skein::benchmarks
