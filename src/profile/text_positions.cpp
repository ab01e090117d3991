#include "text_positions.hpp"

#include <algorithm>

namespace skein::profile {
namespace {

constexpr std::size_t kStride = 256;

bool starts_character(char c) { return (c & 0xC0) != 0x80; }

}  // namespace

TextPositions::TextPositions(std::string_view text) : text_(text) {
  std::size_t characters = 0;
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (at % kStride == 0) characters_before_.push_back(characters);
    if (starts_character(text[at])) ++characters;
    if (text[at] == '\n') line_starts_.push_back(at + 1);
  }
  characters_before_.push_back(characters);
}

std::size_t TextPositions::characters_before(std::size_t offset) const {
  const std::size_t step = offset / kStride;
  const auto rest = text_.substr(step * kStride, offset % kStride);
  return characters_before_[step] +
         static_cast<std::size_t>(std::count_if(rest.begin(), rest.end(), starts_character));
}

std::pair<int, int> TextPositions::line_and_column(std::size_t offset) const {
  const auto after = std::upper_bound(line_starts_.begin(), line_starts_.end(), offset);
  const std::size_t column = characters_before(offset) - characters_before(*(after - 1));
  return {static_cast<int>(after - line_starts_.begin()), static_cast<int>(column) + 1};
}

}  // namespace skein::profile
