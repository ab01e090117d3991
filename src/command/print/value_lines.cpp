#include "value_lines.hpp"

#include <poll.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

namespace skein::command {

std::optional<std::string> ValueLines::next() {
  std::size_t searched = 0;
  while (true) {
    const std::size_t size = unread_.find('\n', searched);
    if (size != std::string::npos) {
      std::string line = take_line(size);
      if (!line.empty()) return line;
      searched = 0;
      continue;
    }
    if (ended_) break;
    searched = unread_.size();
    if (!wait_for_input()) return std::nullopt;
    read_more();
  }
  std::string last = take_line(unread_.size());
  if (last.empty()) return std::nullopt;
  return last;
}

std::string ValueLines::take_line(std::size_t size) {
  std::string line = unread_.substr(0, size);
  unread_.erase(0, size + 1);
  if (line.ends_with('\r')) line.pop_back();
  return line;
}

/// False when a signal comes.
bool ValueLines::wait_for_input() const {
  std::array<pollfd, 2> inputs{pollfd{STDIN_FILENO, POLLIN, 0}, pollfd{signals_.get(), POLLIN, 0}};
  while (!interruption_.came()) {
    ::poll(inputs.data(), inputs.size(), -1);
    if (inputs[0].revents != 0) return true;
  }
  return false;
}

void ValueLines::read_more() {
  std::array<char, 64 * 1024> part;
  const ssize_t size = ::read(STDIN_FILENO, part.data(), part.size());
  if (size > 0) {
    unread_.append(part.data(), static_cast<std::size_t>(size));
  } else if (size == 0) {
    ended_ = true;
  } else if (errno != EAGAIN && errno != EINTR) {
    throw Unavailable(std::string("standard input cannot be read: ") + std::strerror(errno));
  }
}

}  // namespace skein::command
