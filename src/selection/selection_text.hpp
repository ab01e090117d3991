#pragma once

#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <initializer_list>
#include <string>
#include <string_view>

#include "skein/clock.hpp"

/// How reasons are put in words.
namespace skein::selection_text {

/// The parts one after the other: each decision words its reasons, so they are put together at
/// once.
inline std::string joined(std::initializer_list<std::string_view> parts) {
  std::size_t size = 0;
  for (const std::string_view part : parts) size += part.size();
  std::string text;
  text.reserve(size);
  for (const std::string_view part : parts) text += part;
  return text;
}

/// With three decimals at most; from a thousand on whole.
inline std::string number(double value) {
  if (std::abs(value) >= 1000) value = std::round(value);
  std::array<char, 330> room;  // the greatest double has 309 digits
  const char* const begin = room.data();
  const char* end =
      std::to_chars(room.data(), room.data() + room.size(), value, std::chars_format::fixed, 3).ptr;
  if (std::string_view(begin, end).find('.') != std::string_view::npos) {
    while (end[-1] == '0') --end;
    if (end[-1] == '.') --end;
  }
  return {begin, end};
}

inline std::string percent(double share) { return std::to_string(std::lround(100 * share)) + " %"; }

/// Whole milliseconds; below ten with a tenth.
inline std::string in_ms(Duration duration) {
  const auto signed_tenths =
      std::chrono::duration_cast<std::chrono::duration<long long, std::ratio<1, 10000>>>(duration)
          .count();
  const std::string sign = signed_tenths < 0 ? "-" : "";
  const auto tenths = std::abs(signed_tenths);
  if (tenths >= 100 || tenths % 10 == 0) return sign + std::to_string(tenths / 10) + " ms";
  return sign + std::to_string(tenths / 10) + "." + std::to_string(tenths % 10) + " ms";
}

}  // namespace skein::selection_text
