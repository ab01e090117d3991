#include "adopted_processes.hpp"

#include <sys/prctl.h>
#include <sys/wait.h>

#include <algorithm>
#include <cerrno>

#include "mission/process/numbered_entries.hpp"
#include "mission/process/wake_up.hpp"

namespace skein::launch {
namespace {

// Processes that multiply faster than they are killed are left to PID 1 above.
constexpr int kMostRounds = 200;

/// Asks the kernel, not /proc/PID/stat: /proc may be that of another PID namespace.
bool is_child(pid_t process) {
  siginfo_t ignored{};
  return ::waitid(P_PID, static_cast<id_t>(process), &ignored, WEXITED | WNOHANG | WNOWAIT) == 0;
}

std::vector<pid_t> children() {
  std::vector<pid_t> found;
  for_each_number_in("/proc", [&](pid_t process, int) {
    if (is_child(process)) found.push_back(process);
  });
  return found;
}

/// Never destroyed: on another thread the handler may still run when its signal has another action.
StopRequest& end_of_a_child() {
  static auto* its = new StopRequest;
  return *its;
}

/// Runs on whichever thread the kernel chooses. A descriptor of signals would miss those that reach
/// a thread that does not block them.
void tell_of_end(int) {
  const int error = errno;
  end_of_a_child().raise();
  errno = error;
}

}  // namespace

AdoptedProcesses::AdoptedProcesses() : earlier_(children()) {
  ::prctl(PR_GET_CHILD_SUBREAPER, &adopted_before_);
  ::prctl(PR_SET_CHILD_SUBREAPER, 1);
  end_of_a_child();  // No handler may be the first to call it.
  struct sigaction action {};
  action.sa_handler = tell_of_end;
  action.sa_flags = SA_RESTART | SA_NOCLDSTOP;
  ::sigaction(SIGCHLD, &action, &action_before_);
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGCHLD);
  pthread_sigmask(SIG_UNBLOCK, &signals, &mask_before_);
}

AdoptedProcesses::~AdoptedProcesses() {
  end();
  pthread_sigmask(SIG_SETMASK, &mask_before_, nullptr);
  ::sigaction(SIGCHLD, &action_before_, nullptr);
  ::prctl(PR_SET_CHILD_SUBREAPER, adopted_before_);
}

int AdoptedProcesses::descriptor() const noexcept { return end_of_a_child().descriptor(); }

void AdoptedProcesses::reap(const std::function<bool(pid_t)>& is_awaited) noexcept {
  end_of_a_child().take();
  while (true) {
    siginfo_t ended{};
    // WNOWAIT: whether it may be reaped depends on which one it is.
    if (::waitid(P_ALL, 0, &ended, WEXITED | WNOHANG | WNOWAIT) != 0) return;
    if (ended.si_pid == 0 || is_awaited(ended.si_pid)) return;
    ::waitpid(ended.si_pid, nullptr, WNOHANG);
  }
}

void AdoptedProcesses::end() {
  for (int round = 0; round < kMostRounds; ++round) {
    std::vector<pid_t> adopted = children();
    std::erase_if(adopted, [&](pid_t child) {
      return std::ranges::count(earlier_, child) > 0 || ::kill(child, SIGKILL) != 0;
    });
    if (adopted.empty()) return;
    // A child keeps its number until it is waited for, so the signal has reached no other process.
    for (const pid_t child : adopted) ::waitpid(child, nullptr, 0);
  }
}

}  // namespace skein::launch
