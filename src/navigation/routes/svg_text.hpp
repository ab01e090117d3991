#pragma once

#include <fmt/core.h>

#include <cmath>
#include <string>
#include <string_view>
#include <utility>

namespace skein::navigation {

/// SVG that grows line by line.
class Svg {
 public:
  template <class... Arguments>
  void add(fmt::format_string<Arguments...> text, Arguments&&... arguments) {
    text_ += fmt::format(text, std::forward<Arguments>(arguments)...);
    text_ += '\n';
  }
  std::string take() { return std::move(text_); }

 private:
  std::string text_;
};

/// Text as XML takes it; what XML cannot hold at all becomes a question mark.
inline std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += static_cast<unsigned char>(c) < 0x20 ? '?' : c;
    }
  }
  return out;
}

/// For scales: 1, 2 or 5 times a power of ten, not more than `most`.
inline double round_number(double most) {
  const double power = std::pow(10, std::floor(std::log10(most)));
  for (const double factor : {5.0, 2.0}) {
    if (factor * power <= most) return factor * power;
  }
  return power;
}

/// The colour of the nth route; they repeat after eight.
inline std::string_view route_colour(std::size_t route) {
  constexpr std::string_view kColours[] = {"#1746c7", "#e8590c", "#087f5b", "#9c1fb0",
                                           "#111827", "#b08900", "#0c8599", "#c2255c"};
  return kColours[route % std::size(kColours)];
}

}  // namespace skein::navigation
