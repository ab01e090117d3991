#include "become_program.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>

#include "numbered_entries.hpp"

namespace skein::launch {
namespace {

constexpr int kParentHasEnded = 127;

void close_one(int descriptor, Closing closing) noexcept {
  if (closing == Closing::AtOnce)
    ::close(descriptor);
  else
    ::fcntl(descriptor, F_SETFD, FD_CLOEXEC);
}

/// Without /proc. A limit that was lowered does not close the descriptors above it: these remain.
void close_up_to_limit(int first, Closing closing) noexcept {
  constexpr rlim_t kMost = 1 << 20;  // the kernel's usual fs.nr_open
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) limit.rlim_cur = kMost;
  const int end = static_cast<int>(std::min(limit.rlim_cur, kMost));
  for (int descriptor = first; descriptor < end; ++descriptor) close_one(descriptor, closing);
}

const char* reset_signals() noexcept {
  for (int signal = 1; signal < NSIG; ++signal) ::signal(signal, SIG_DFL);
  sigset_t none;
  sigemptyset(&none);
  return ::sigprocmask(SIG_SETMASK, &none, nullptr) == 0 ? nullptr : "sigprocmask";
}

}  // namespace

void close_from(int first, Closing closing) noexcept {
  const int flags = closing == Closing::OnExec ? CLOSE_RANGE_CLOEXEC : 0;
  if (::close_range(static_cast<unsigned>(first), ~0U, flags) == 0) return;
  const bool all = for_each_number_in("/proc/self/fd", [&](int descriptor, int folder) {
    if (descriptor >= first && descriptor != folder) close_one(descriptor, closing);
  });
  if (!all) close_up_to_limit(first, closing);
}

const char* become_program(const Launchpad& pad) noexcept {
  if (::setpgid(0, 0) != 0) return "setpgid";
  if (::prctl(PR_SET_PDEATHSIG, SIGKILL) != 0) return "prctl";
  if (::getppid() != pad.parent) ::_exit(kParentHasEnded);  // before the line above
  if (const char* refused = reset_signals()) return refused;
  for (std::size_t i = 0; i < pad.descriptors.size(); ++i)
    if (::dup2(pad.descriptors[i], static_cast<int>(i)) < 0) return "dup2";
  close_from(static_cast<int>(pad.descriptors.size()), Closing::OnExec);
  ::execvpe(pad.arguments[0], pad.arguments, pad.environment);
  return "execve";
}

}  // namespace skein::launch
