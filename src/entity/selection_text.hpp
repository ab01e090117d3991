#pragma once

#include <cmath>
#include <string>

#include "skein/core/clock.hpp"

/// How reasons are put in words.
namespace skein::selection_text {

/// With three decimals at most; from a thousand on whole.
inline std::string number(double value) {
  if (std::abs(value) >= 1000) value = std::round(value);
  std::string text = std::to_string(value);
  text.erase(text.size() - 3);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

inline std::string percent(double share) { return std::to_string(std::lround(100 * share)) + " %"; }

/// Whole milliseconds; below ten with a tenth.
inline std::string in_ms(Duration duration) {
  const auto tenths =
      std::chrono::duration_cast<std::chrono::duration<long long, std::ratio<1, 10000>>>(duration)
          .count();
  if (tenths >= 100 || tenths % 10 == 0) return std::to_string(tenths / 10) + " ms";
  return std::to_string(tenths / 10) + "." + std::to_string(tenths % 10) + " ms";
}

}  // namespace skein::selection_text
