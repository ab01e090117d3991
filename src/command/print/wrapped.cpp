#include "wrapped.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <sstream>

namespace skein::command {
namespace {

std::string folded_line(std::string line, std::size_t width) {
  const std::size_t indent = std::min(line.find_first_not_of(' '), line.size()) + 4;
  std::string lines;
  std::size_t begin = line.find_first_not_of(' ');
  while (line.size() > width) {
    std::size_t end = line.rfind(' ', width);
    if (end == std::string::npos || end <= begin) end = line.find(' ', begin);
    const std::size_t next = line.find_first_not_of(' ', end);
    if (next == std::string::npos) break;
    lines += line.substr(0, end) + "\n";
    line = std::string(indent, ' ') + line.substr(next);
    begin = indent;
  }
  return lines + line;
}

}  // namespace

std::string folded(std::string_view text, std::size_t width) {
  if (width == 0) return std::string(text);
  std::string lines;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    lines += folded_line(std::string(text.substr(at, end - at)), width);
    if (end < text.size()) lines += '\n';
    at = end + 1;
  }
  return lines;
}

std::size_t terminal_width() {
  winsize size{};
  return ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 ? size.ws_col : 0;
}

std::string wrapped(std::string_view text, std::size_t width, std::size_t indent) {
  std::string lines;
  std::size_t column = indent;
  std::istringstream words{std::string(text)};
  for (std::string word; words >> word;) {
    if (column > indent && column + 1 + word.size() > width) {
      lines += "\n" + std::string(indent, ' ');
      column = indent;
    }
    if (column > indent) lines += ' ', ++column;
    lines += word;
    column += word.size();
  }
  return lines;
}

}  // namespace skein::command
