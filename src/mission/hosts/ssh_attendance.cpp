#include "mission/hosts/ssh_attendance.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <optional>

#include "core/printable.hpp"
#include "mission/process/become_program.hpp"
#include "mission/process/line_splitter.hpp"
#include "mission/process/pipe.hpp"
#include "mission/process/ready.hpp"
#include "mission/process/wake_up.hpp"
#include "mission/supervise/supervisor.hpp"

namespace skein::launch {
namespace {

using Kind = AttendedReport::Kind;
constexpr int kSshFailed = 255;
constexpr int kNotFound = 127;

struct Ssh {
  pid_t id = -1;
  FileDescriptor input;
  FileDescriptor output;
  FileDescriptor errors;
};

/// In a process group of its own: a signal that ends this one's must not cut the connection.
Ssh start_ssh(const SshAttendance& attendance) {
  Pipe input = make_pipe();
  Pipe output = make_pipe();
  Pipe errors = make_pipe();
  auto words = ssh_command(attendance);
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const std::array descriptors{input.read_end.get(), output.write_end.get(),
                               errors.write_end.get()};
  const Launchpad pad{arguments.data(), environ, descriptors, ::getpid()};
  const pid_t id = ::fork();
  if (id < 0) throw_system_error("a process");
  if (id == 0) {
    const char* const call = become_program(pad);
    const std::string reason = std::string("ssh: ") + call + ": " + std::strerror(errno) + "\n";
    [[maybe_unused]] const auto written =
        ::write(errors.write_end.get(), reason.data(), reason.size());
    ::_exit(kSshFailed);
  }
  return {id, std::move(input.write_end), std::move(output.read_end), std::move(errors.read_end)};
}

class Attending {
 public:
  explicit Attending(const SshAttendance& attendance)
      : attendance_(attendance), ssh_(start_ssh(attendance)) {
    ::signal(SIGPIPE, SIG_IGN);
    ::fcntl(ssh_.input.get(), F_SETFL, O_NONBLOCK);
    report_waiting("connects to " + attendance.host + " by ssh");
  }

  int run() {
    while (ssh_.output || ssh_.errors) {
      std::array<pollfd, 3> watched{{{ssh_.output.get(), POLLIN, 0},
                                     {ssh_.errors.get(), POLLIN, 0},
                                     {signals_.descriptor(), POLLIN, 0}}};
      ::poll(watched.data(), watched.size(), static_cast<int>((kHeartbeat / 2).count()));
      if (watched[0].revents != 0) read(ssh_.output, output_lines_, true);
      if (watched[1].revents != 0) read(ssh_.errors, error_lines_, false);
      while (signals_.take().number != 0) stop();
      if (started_ && std::chrono::steady_clock::now() >= next_heartbeat_) say(kAlive);
    }
    int status = 0;
    while (::waitpid(ssh_.id, &status, 0) < 0 && errno == EINTR) {
    }
    return exit_code(WIFEXITED(status) ? WEXITSTATUS(status) : kSshFailed);
  }

 private:
  void read(FileDescriptor& from, LineSplitter& lines, bool may_be_reports) {
    std::array<char, 16 * 1024> buffer;
    const auto size = ::read(from.get(), buffer.data(), buffer.size());
    const auto take = [&](std::string_view line) {
      const auto report = may_be_reports ? maybe_report(line) : std::nullopt;
      if (report) return take_report(*report);
      last_text_ = printable(line, kLongestReason);
      attendance_.on_text(line);
    };
    if (size > 0) lines.add({buffer.data(), static_cast<std::size_t>(size)}, take);
    if (size > 0 || (size < 0 && errno == EINTR)) return;
    lines.finish(take);
    from.reset();
  }

  void take_report(const AttendedReport& report) {
    switch (report.kind) {
      case Kind::Hello:
        greet(report.text);
        break;
      case Kind::Ready:
        ready_ = true;
        report_ready();
        break;
      case Kind::Ended:
        ended_ = report.exit_code;
        if (report.exit_code == 0 || stopping_) break;
        report_waiting(report.text);
        attendance_.on_text("ends: " + report.text);
        break;
      case Kind::Output:
      case Kind::Event:
        break;
    }
    attendance_.on_report(report);
  }

  void greet(const std::string& hello) {
    if (hello == attendance_.hello) {
      started_ = true;
      report_waiting("processes on " + attendance_.host + " become ready");
      return say(kGo);
    }
    refused_ = true;
    last_text_ = "Skein on " + attendance_.host + " is '" + hello + "', here it is '" +
                 attendance_.hello +
                 "'; install the same version there, and copy the profile with all that it names";
    attendance_.on_text(last_text_);
    ssh_.input.reset();
  }

  void stop() {
    stopping_ = true;
    if (started_) return say(kStop);
    ssh_.input.reset();
    ::kill(ssh_.id, SIGTERM);  // it connects still, perhaps to nobody
  }

  /// What does not go through is not waited for: the other side misses the heartbeat, then.
  void say(std::string_view word) {
    next_heartbeat_ = std::chrono::steady_clock::now() + kHeartbeat;
    const std::string line = std::string(word) + "\n";
    [[maybe_unused]] const auto written = ::write(ssh_.input.get(), line.data(), line.size());
  }

  int exit_code(int ssh_code) const {
    if (ended_) return *ended_;
    std::string reason = last_text_;
    if (ssh_code == kNotFound) reason = "there is no Skein on " + attendance_.host + ": " + reason;
    if (refused_ || ssh_code == kConfigurationError) {
      report_waiting(reason);
      return kConfigurationError;
    }
    if (ready_) attendance_.on_text("the connection to " + attendance_.host + " is lost");
    report_waiting(reason.empty() ? "ssh ended without a word" : reason);
    return ready_ ? kPeerLost : kStartFailed;
  }

  const SshAttendance& attendance_;
  SignalReader signals_;
  Ssh ssh_;
  LineSplitter output_lines_;
  LineSplitter error_lines_;
  Time next_heartbeat_{};
  bool started_ = false;
  bool ready_ = false;
  bool refused_ = false;
  bool stopping_ = false;
  std::optional<int> ended_;
  std::string last_text_;
};

}  // namespace

std::vector<std::string> ssh_command(const SshAttendance& attendance) {
  return {"ssh", "-T", "-oBatchMode=yes", "-oConnectTimeout=10", "-oServerAliveInterval=1",
          "-oServerAliveCountMax=3",
          // A connection that others share would outlive the link that this one watches.
          "-oControlMaster=no", "-oControlPath=none", "--", attendance.host, attendance.command};
}

int attend_over_ssh(const SshAttendance& attendance) { return Attending(attendance).run(); }

}  // namespace skein::launch
