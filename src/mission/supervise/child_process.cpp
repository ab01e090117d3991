#include "child_process.hpp"

#include <fcntl.h>
#include <sys/syscall.h>
#include <sys/wait.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "mission/process/become_program.hpp"
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

/// What the child tells before it ends, if it cannot become the program. Parent and child are one
/// image, so that the text lies at the same place.
struct Refusal {
  int reason = 0;
  const char* call = nullptr;
};

[[noreturn]] void execute(const Launchpad& pad, int failure, GroupGuard& guard) {
  guard.add(::getpid());
  const char* const call = become_program(pad);
  const Refusal refusal{errno, call};
  [[maybe_unused]] const auto written = ::write(failure, &refusal, sizeof refusal);
  ::_exit(kCannotExecute);
}

[[noreturn]] void refuse(const std::string& program, const Refusal& refusal) {
  const std::string how = refusal.call == std::string_view("execve")
                              ? "cannot execute " + program
                              : "cannot start " + program + ": " + refusal.call;
  throw SystemError(how, refusal.reason);
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
  const FileDescriptor opened(::open("/dev/null", O_RDONLY | O_CLOEXEC));
  if (!opened) throw SystemError("cannot open /dev/null", errno);
  const FileDescriptor null_input(::fcntl(opened.get(), F_DUPFD_CLOEXEC, kFirstPipeEnd));
  if (!null_input) throw SystemError("cannot open /dev/null", errno);
  auto arguments = plan.argv;
  auto environment = environment_of(plan, mark_);
  const auto argument_pointers = pointers_to(arguments);
  const auto environment_pointers = pointers_to(environment);
  std::array<int, kReadyDescriptor + 1> descriptors;
  descriptors.fill(output.write_end.get());
  descriptors[STDIN_FILENO] = null_input.get();
  descriptors[kReadyDescriptor] = readiness.write_end.get();
  const Launchpad pad{argument_pointers.data(), environment_pointers.data(), descriptors,
                      ::getpid()};
  id_ = ::fork();
  if (id_ < 0) throw_system_error("a process");
  if (id_ == 0) execute(pad, failure.write_end.get(), guard_);
  ::setpgid(id_, id_);  // The child does the same; whoever comes first, the group is there now.
  failure.write_end.reset();
  Refusal refusal;
  while (::read(failure.read_end.get(), &refusal, sizeof refusal) < 0 && errno == EINTR) {
  }
  if (refusal.call != nullptr) {
    end_group();
    refuse(plan.argv[0], refusal);
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
  // First the leader, then its orphans, which come to the launcher (see AdoptedProcesses).
  wait(id_);
  wait(-id_);
  kill_marked_processes(mark_);
  guard_.remove(id_);
  id_ = -1;
}

}  // namespace skein::launch
