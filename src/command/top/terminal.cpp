#include "terminal.hpp"

#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <thread>

namespace skein::command::top {
namespace {

constexpr const char* kEnter = "\x1b[?1049h\x1b[?25l";
constexpr const char* kLeave = "\x1b[?25h\x1b[?1049l";

void write(const std::string& text) {
  std::fwrite(text.data(), 1, text.size(), stdout);
  std::fflush(stdout);
}

bool can_move_cursor() {
  const char* const kind = std::getenv("TERM");
  return isatty(STDOUT_FILENO) && kind && *kind && std::string(kind) != "dumb";
}

winsize size_of_screen() {
  winsize size{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) size = {24, 80, 0, 0};
  return size;
}

std::string styled(const Line& line, bool colours) {
  switch (line.style) {
    case Line::Style::Plain:
      return line.text;
    case Line::Style::Head:
      return "\x1b[1m" + line.text + "\x1b[m";
    case Line::Style::Title:
      return "\x1b[7m" + line.text + "\x1b[m";
    case Line::Style::Alarm:
      break;
  }
  return (colours ? "\x1b[31m" : "\x1b[1m") + line.text + "\x1b[m";
}

}  // namespace

Terminal::Terminal() : screen_(can_move_cursor()) {
  if (!screen_) return;
  const char* const no_colour = std::getenv("NO_COLOR");
  colours_ = !no_colour || !*no_colour;
  keys_ = isatty(STDIN_FILENO) && tcgetattr(STDIN_FILENO, &before_) == 0;
  if (keys_) {
    termios raw = before_;
    raw.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);  // Ctrl-C stays a signal
    raw.c_cc[VSUSP] = _POSIX_VDISABLE;
    tcsetattr(STDIN_FILENO, TCSANOW, &raw);
  }
  write(kEnter);
}

Terminal::~Terminal() {
  if (!screen_) return;
  write(kLeave);
  if (keys_) tcsetattr(STDIN_FILENO, TCSANOW, &before_);
}

std::size_t Terminal::width() const { return size_of_screen().ws_col; }

std::optional<std::size_t> Terminal::height() const {
  if (!screen_) return std::nullopt;
  return size_of_screen().ws_row;
}

void Terminal::show(const std::vector<Line>& lines) const {
  std::string text = screen_ ? "\x1b[H" : "";
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (!screen_) {
      text += lines[i].text + "\n";
      continue;
    }
    // No line break behind the last line: it would scroll the screen.
    text += styled(lines[i], colours_) + "\x1b[K" + (i + 1 < lines.size() ? "\r\n" : "");
  }
  write(text + (screen_ ? "\x1b[J" : "\n"));
}

std::string Terminal::typed(std::chrono::milliseconds time) const {
  if (!keys_) {
    std::this_thread::sleep_for(time);
    return {};
  }
  pollfd input{STDIN_FILENO, POLLIN, 0};
  if (poll(&input, 1, static_cast<int>(time.count())) <= 0) return {};
  char bytes[64];
  const ssize_t size = read(STDIN_FILENO, bytes, sizeof bytes);
  if (size > 0) return std::string(bytes, static_cast<std::size_t>(size));
  std::this_thread::sleep_for(time);  // the terminal has gone; a signal will end this
  return {};
}

}  // namespace skein::command::top
