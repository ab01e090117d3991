#include "group_guard.hpp"

#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>

#include "become_program.hpp"
#include "marked_processes.hpp"
#include "wake_up.hpp"

namespace skein::launch {
namespace {

constexpr std::size_t kMaxGroups = 4096;

/// Makes this child the guard; errno says why not. A session of its own: what is sent to the
/// launcher's terminal or group must not end the guard. Its name is for people alone.
bool become_guard(int launcher) {
  ::prctl(PR_SET_NAME, "skein-guard");
  sigset_t all;
  sigfillset(&all);
  if (::setsid() < 0 || ::sigprocmask(SIG_SETMASK, &all, nullptr) != 0) return false;
  if (::dup2(launcher, STDIN_FILENO) < 0) return false;
  close_from(STDIN_FILENO + 1, Closing::AtOnce);
  return true;
}

/// The body of the guard. It is forked, not executed, so that it uses system calls only. First it
/// sends 0 to the launcher, or what keeps it from guarding.
[[noreturn]] void guard_groups(int launcher, const std::string& mark) {
  const int reason = become_guard(launcher) ? 0 : errno;
  ::send(reason == 0 ? STDIN_FILENO : launcher, &reason, sizeof reason, MSG_NOSIGNAL);
  if (reason != 0) ::_exit(1);

  static std::array<pid_t, kMaxGroups> groups;
  std::size_t count = 0;
  pid_t message = 0;
  while (true) {
    const auto size = ::read(0, &message, sizeof message);
    if (size < 0 && errno == EINTR) continue;
    if (size != sizeof message) break;
    if (message > 0 && count < kMaxGroups) groups[count++] = message;
    if (message < 0) {
      count = static_cast<std::size_t>(
          std::remove(groups.begin(), groups.begin() + count, -message) - groups.begin());
    }
  }
  for (std::size_t i = 0; i < count; ++i) ::kill(-groups[i], SIGKILL);
  kill_marked_processes(mark);
  ::_exit(0);
}

}  // namespace

GroupGuard::GroupGuard() : mark_(make_mark()) {
  std::array<int, 2> ends{};
  // No pipe: a write after the guard's end must not be this process's.
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
    throw_system_error("a pair of sockets");
  FileDescriptor input(ends[0]);
  groups_ = FileDescriptor(ends[1]);
  guard_ = ::fork();
  if (guard_ < 0) throw_system_error("its guard process");
  if (guard_ == 0) guard_groups(input.get(), mark_);
  input.reset();
  int reason = ECHILD;  // if it has ended without a word
  while (::read(groups_.get(), &reason, sizeof reason) < 0 && errno == EINTR) {
  }
  if (reason == 0) return;
  end();
  errno = reason;
  throw_system_error("its guard process");
}

GroupGuard::~GroupGuard() { end(); }

void GroupGuard::end() noexcept {
  groups_.reset();
  while (::waitpid(guard_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

void GroupGuard::send(pid_t message) noexcept {
  while (::send(groups_.get(), &message, sizeof message, MSG_NOSIGNAL) < 0 && errno == EINTR) {
  }
}

}  // namespace skein::launch
