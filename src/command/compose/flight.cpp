#include "flight.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "command/print/start_program.hpp"
#include "core/printable.hpp"
#include "core/threads/start_thread.hpp"
#include "skein/error.hpp"

namespace skein::command::compose {
namespace {

constexpr int kLookMilliseconds = 200;
constexpr std::size_t kKept = 4096;
constexpr std::size_t kLongestLine = 512;

/// The reason in the output of the launcher, or else its last line.
std::string reason_in(const std::string& said) {
  constexpr std::string_view kReason = "skein: ";
  std::string last;
  for (std::size_t at = 0; at < said.size();) {
    const std::size_t end = std::min(said.find('\n', at), said.size());
    const std::string line = said.substr(at, end - at);
    at = end + 1;
    if (line.starts_with(kReason)) return printable(line.substr(kReason.size()), kLongestLine);
    if (!line.empty()) last = line;
  }
  return printable(last, kLongestLine);
}

}  // namespace

Flight::Flight(const std::vector<std::string>& words) {
  std::array<int, 2> ends;
  if (::pipe2(ends.data(), O_CLOEXEC) != 0)
    throw Unavailable(std::string("no pipe: ") + std::strerror(errno));
  said_ = FileDescriptor(ends[0]);
  const FileDescriptor theirs(ends[1]);
  process_ = start_program(words, {-1, -1, theirs.get()}, Session::Own);
  try {
    thread_ = start_thread("skein-flight", [this] { run(); });
  } catch (const Error&) {
    ::kill(process_, SIGTERM);  // nobody would watch it
    ::waitpid(process_, nullptr, 0);
    throw;
  }
}

Flight::~Flight() {
  forgotten_ = true;
  thread_.join();
}

std::string Flight::end() const {
  std::lock_guard lock(mutex_);
  return end_;
}

/// False at the end of all that the launcher says.
bool Flight::read() {
  std::array<char, 1024> part;
  const auto size = ::read(said_.get(), part.data(), part.size());
  if (size < 0 && errno == EINTR) return true;
  if (size <= 0) return false;
  std::lock_guard lock(mutex_);
  last_.append(part.data(), static_cast<std::size_t>(size));
  if (last_.size() > kKept) last_.erase(0, last_.size() - kKept);
  return true;
}

void Flight::run() {
  int status = 0;
  pid_t ended = 0;
  for (bool speaks = true; ended == 0;) {
    if (forgotten_) return;
    pollfd readable{said_.get(), POLLIN, 0};
    const bool has_said =
        ::poll(speaks ? &readable : nullptr, speaks ? 1 : 0, kLookMilliseconds) > 0;
    if (has_said) {
      speaks = read();
    } else {
      ended = ::waitpid(process_, &status, WNOHANG);
    }
  }
  std::lock_guard lock(mutex_);
  const int code = exit_code_of(status);
  const std::string reason = reason_in(last_);
  if (ended < 0) {
    end_ = "ended, nobody knows how";
  } else if (code == 0) {
    end_ = "ended well";
  } else {
    end_ = "ended with exit code " + std::to_string(code) + (reason.empty() ? "" : ": " + reason);
  }
}

}  // namespace skein::command::compose
