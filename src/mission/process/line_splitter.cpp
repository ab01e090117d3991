#include "line_splitter.hpp"

#include <algorithm>

namespace skein::launch {

void LineSplitter::add(std::string_view bytes, const OnLine& on_line) {
  while (!bytes.empty()) {
    const auto line_break = bytes.find('\n');
    const bool complete = line_break != std::string_view::npos;
    const auto part = bytes.substr(0, complete ? line_break : bytes.size());
    const auto room = kLongestLine - rest_.size();
    rest_.append(part.substr(0, room));
    if (part.size() > room) {
      finish(on_line);
      bytes.remove_prefix(room);
      continue;
    }
    bytes.remove_prefix(part.size() + (complete ? 1 : 0));
    if (!complete) return;
    if (!rest_.empty() && rest_.back() == '\r') rest_.pop_back();
    on_line(rest_);
    rest_.clear();
  }
}

void LineSplitter::finish(const OnLine& on_line) {
  if (rest_.empty()) return;
  on_line(rest_);
  rest_.clear();
}

}  // namespace skein::launch
