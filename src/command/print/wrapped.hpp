#pragma once

#include <string>
#include <string_view>

namespace skein::command {

/// The words of a text in lines that end before column `width`, all but the first of which begin
/// with `indent` blanks; a longer word has a line of its own.
std::string wrapped(std::string_view text, std::size_t width, std::size_t indent);

/// Lines that are longer than `width` in several, broken at blanks; what follows is indented by
/// four more. A longer word stays whole. With a width of 0 the text as it is.
std::string folded(std::string_view text, std::size_t width);

/// The columns of the terminal that stdout is; 0 where it is none.
std::size_t terminal_width();

}  // namespace skein::command
