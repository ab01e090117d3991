#include "words.hpp"

#include <algorithm>

#include "core/printable.hpp"
#include "core/suggestion.hpp"

namespace skein::profile {
namespace {

constexpr std::size_t kLongestQuote = 80;
constexpr std::size_t kLongestWord = 64;
constexpr std::size_t kMaxListed = 12;
constexpr std::size_t kMaxCompared = 1000;

}  // namespace

std::string shortened(std::string_view text) {
  std::size_t length = std::min(text.size(), kLongestQuote);
  while (length > 0 && length < text.size() && (text[length] & 0xC0) == 0x80) --length;
  const std::string result = printable(text.substr(0, length));
  return length < text.size() ? result + "..." : result;
}

std::string in_quotes(std::string_view text) { return "\"" + shortened(text) + "\""; }

std::string remedy_for(std::string_view unknown, const std::vector<std::string_view>& known) {
  std::vector<std::string> comparable;
  for (std::size_t i = 0; i < std::min(known.size(), kMaxCompared); ++i) {
    if (known[i].size() <= kLongestWord) comparable.emplace_back(known[i]);
  }
  const std::string near = unknown.size() > kLongestWord ? "" : suggestion(unknown, comparable);
  if (!near.empty()) return near.substr(2, near.size() - 3);  // without its blank and parentheses
  if (known.empty()) return "none is known here";
  std::string text = known.size() == 1 ? "known is" : "known are";
  for (std::size_t i = 0; i < std::min(known.size(), kMaxListed); ++i) {
    text += (i == 0 ? " " : ", ") + in_quotes(known[i]);
  }
  return known.size() > kMaxListed ? text + ", ..." : text;
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kWhiteSpace = " \t\r\n";
  const auto first = text.find_first_not_of(kWhiteSpace);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kWhiteSpace) - first + 1);
}

}  // namespace skein::profile
