#include "child_process.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "mission/process/marked_processes.hpp"
#include "mission/process/pipe.hpp"
#include "mission/process/ready.hpp"
#include "mission/process/wake_up.hpp"
#include "skein/error.hpp"

namespace skein::launch {
namespace {

// In the child; a number of one digit, because shells redirect to such numbers only.
constexpr int kReadyDescriptor = 3;
static_assert(kReadyDescriptor < kFirstPipeEnd);
constexpr int kUnknownExitCode = 255;
constexpr int kCannotExecute = 127;

// Debian 12's <sys/pidfd.h> cannot be used from C++: it declares its functions without C linkage.
int open_process(pid_t process) { return static_cast<int>(::syscall(SYS_pidfd_open, process, 0)); }

void make_non_blocking(const FileDescriptor& descriptor) {
  ::fcntl(descriptor.get(), F_SETFL, ::fcntl(descriptor.get(), F_GETFL) | O_NONBLOCK);
}

std::vector<std::string> environment_of(const ChildPlan& plan, const std::string& mark) {
  auto added = plan.environment;
  added.emplace_back(kReadyVariable, std::to_string(kReadyDescriptor));
  // What this launcher starts is also its own launcher's, if it has one.
  const char* above = std::getenv(kMarkVariable);
  added.emplace_back(kMarkVariable, (above == nullptr ? "" : std::string(above) + " ") + mark);
  std::vector<std::string> entries;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string_view text(*entry);
    bool replaced = false;
    for (const auto& [name, value] : added) {
      replaced = replaced || text.substr(0, text.find('=')) == name;
    }
    if (!replaced) entries.emplace_back(text);
  }
  for (const auto& [name, value] : added) entries.push_back(name + "=" + value);
  return entries;
}

std::vector<char*> pointers_to(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  for (auto& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

/// What the child needs between fork and exec, where nothing may be allocated.
struct Launchpad {
  char* const* arguments;
  char* const* environment;
  int null_input;
  int output;
  int readiness;
  int failure;
  pid_t launcher;
};

[[noreturn]] void execute(const Launchpad& pad, GroupGuard& guard) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != pad.launcher) ::_exit(kCannotExecute);  // it died before the line above
  guard.add(::getpid());
  for (int signal = 1; signal < NSIG; ++signal) ::signal(signal, SIG_DFL);
  sigset_t none;
  sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  ::dup2(pad.null_input, STDIN_FILENO);
  ::dup2(pad.output, STDOUT_FILENO);
  ::dup2(pad.output, STDERR_FILENO);
  ::dup2(pad.readiness, kReadyDescriptor);
  ::close_range(kFirstPipeEnd, ~0U, CLOSE_RANGE_CLOEXEC);
  ::execvpe(pad.arguments[0], pad.arguments, pad.environment);
  const int reason = errno;
  [[maybe_unused]] const auto written = ::write(pad.failure, &reason, sizeof reason);
  ::_exit(kCannotExecute);
}

}  // namespace

std::string to_text(const ExitStatus& status) {
  if (!status.by_signal) return "with exit code " + std::to_string(status.number);
  const char* name = ::sigdescr_np(status.number);
  return "by signal " + std::to_string(status.number) + " (" + (name ? name : "unknown") + ")";
}

ChildProcess::ChildProcess(const ChildPlan& plan, GroupGuard& guard)
    : guard_(guard), mark_(guard.next_mark()) {
  if (plan.argv.empty()) throw InvalidArgument(plan.name + " has no command line");
  start(plan);
}

void ChildProcess::start(const ChildPlan& plan) {
  auto output = make_pipe();
  auto readiness = make_pipe();
  auto failure = make_pipe();
  const FileDescriptor null_input(::open("/dev/null", O_RDONLY | O_CLOEXEC));
  if (!null_input) throw SystemError("cannot open /dev/null", errno);
  auto arguments = plan.argv;
  auto environment = environment_of(plan, mark_);
  const auto argument_pointers = pointers_to(arguments);
  const auto environment_pointers = pointers_to(environment);
  const Launchpad pad{argument_pointers.data(),
                      environment_pointers.data(),
                      null_input.get(),
                      output.write_end.get(),
                      readiness.write_end.get(),
                      failure.write_end.get(),
                      ::getpid()};
  id_ = ::fork();
  if (id_ < 0) throw_system_error("a process");
  if (id_ == 0) execute(pad, guard_);
  ::setpgid(id_, id_);  // The child does the same; whoever comes first, the group is there now.
  failure.write_end.reset();
  int reason = 0;
  ssize_t size = 0;
  do {
    size = ::read(failure.read_end.get(), &reason, sizeof reason);
  } while (size < 0 && errno == EINTR);
  if (size > 0) {
    end_group();
    throw SystemError("cannot execute " + plan.argv[0], reason);
  }
  end_ = FileDescriptor(open_process(id_));
  if (!end_) {
    const int cause = errno;
    end_group();
    errno = cause;
    throw_system_error("a process descriptor");
  }
  output_ = std::move(output.read_end);
  readiness_ = std::move(readiness.read_end);
  make_non_blocking(output_);
  make_non_blocking(readiness_);
}

ChildProcess::~ChildProcess() { end_group(); }

void ChildProcess::send(int signal) const noexcept {
  if (id_ > 0) ::kill(-id_, signal);
}

std::optional<ExitStatus> ChildProcess::collect() {
  siginfo_t information{};
  // WNOWAIT: as long as the leader is not waited for, the number of its group is nobody else's.
  const int flags = WEXITED | WNOHANG | WNOWAIT;
  const int waited = ::waitid(P_PID, static_cast<id_t>(id_), &information, flags);
  if (waited == 0 && information.si_pid == 0) return std::nullopt;
  end_group();
  // Somebody else in this process waited for the child: how it ended is lost.
  if (waited != 0) return ExitStatus{false, kUnknownExitCode};
  return ExitStatus{information.si_code != CLD_EXITED, information.si_status};
}

void ChildProcess::end_group() noexcept {
  if (id_ < 0) return;
  ::kill(-id_, SIGKILL);
  const auto wait = [](pid_t whom) {
    pid_t found = 0;
    do {
      found = ::waitpid(whom, nullptr, 0);
    } while (found > 0 || (found < 0 && errno == EINTR));
  };
  // First the leader, then what it left behind: orphans come to the launcher (see Supervisor).
  wait(id_);
  wait(-id_);
  kill_marked_processes(mark_);
  guard_.remove(id_);
  id_ = -1;
}

}  // namespace skein::launch
