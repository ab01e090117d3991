#include "flight.hpp"

#include <fcntl.h>
#include <poll.h>
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

/// What the launcher gives as its reason, or else its last line.
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
  thread_ = start_thread("skein-flight", [this] { run(); });
}

Flight::~Flight() {
  forgotten_ = true;
  thread_.join();
}

std::string Flight::end() const {
  std::lock_guard lock(mutex_);
  return end_;
}

void Flight::read() {
  std::array<char, 1024> part;
  const auto size = ::read(said_.get(), part.data(), part.size());
  if (size <= 0) {
    ::poll(nullptr, 0, kLookMilliseconds);  // it has closed it, and ends
    return;
  }
  std::lock_guard lock(mutex_);
  last_.append(part.data(), static_cast<std::size_t>(size));
  if (last_.size() > kKept) last_.erase(0, last_.size() - kKept);
}

void Flight::run() {
  int status = 0;
  while (!forgotten_) {
    pollfd readable{said_.get(), POLLIN, 0};
    if (::poll(&readable, 1, kLookMilliseconds) > 0) {
      read();
    } else if (::waitpid(process_, &status, WNOHANG) == process_) {
      break;
    }
    if ((readable.revents & POLLHUP) != 0 && ::waitpid(process_, &status, WNOHANG) == process_)
      break;
  }
  if (forgotten_) return;
  std::lock_guard lock(mutex_);
  const int code = exit_code_of(status);
  end_ = code == 0 ? "ended well" : "ended with exit code " + std::to_string(code);
  if (const std::string reason = reason_in(last_); code != 0 && !reason.empty())
    end_ += ": " + reason;
}

}  // namespace skein::command::compose
