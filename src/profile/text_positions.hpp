#pragma once

#include <string_view>
#include <utility>
#include <vector>

namespace skein::profile {

/// Lines and columns of a text, found in a time that does not grow with the length of its lines.
class TextPositions {
 public:
  /// `text` must outlive this object.
  explicit TextPositions(std::string_view text);
  /// Both count from 1; columns count characters.
  std::pair<int, int> line_and_column(std::size_t offset) const;

 private:
  std::size_t characters_before(std::size_t offset) const;

  std::string_view text_;
  std::vector<std::size_t> line_starts_{0};
  std::vector<std::size_t> characters_before_;  // at every so many bytes
};

}  // namespace skein::profile
