#include "mission/hosts/attended_run.hpp"

#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <set>
#include <thread>

#include "core/system/ending_signals.hpp"
#include "mission/hosts/attended_report.hpp"
#include "mission/process/line_splitter.hpp"
#include "mission/process/wake_up.hpp"

namespace skein::launch {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

/// For the way of the hello, and back.
constexpr milliseconds kHelloPatience{10'000};

bool becomes(int descriptor, short event, milliseconds limit) {
  pollfd watched{descriptor, event, 0};
  return ::poll(&watched, 1, static_cast<int>(limit.count())) > 0;
}

/// The other launcher: what it says, and what it is told.
class Attendant {
 public:
  Attendant(int input, int output) : input_(input), output_(output) {
    ::fcntl(output_, F_SETFL, ::fcntl(output_, F_GETFL) | O_NONBLOCK);
  }

  /// Once it does not take what it is told, nothing more is told.
  void tell(const AttendedReport& report) {
    if (lost_) return;
    const std::string line = to_line(report);
    const auto end = steady_clock::now() + kAttendancePatience;
    for (std::size_t at = 0; at < line.size();) {
      const auto size = ::write(output_, line.data() + at, line.size() - at);
      if (size > 0) at += static_cast<std::size_t>(size);
      const bool may_go_on = size > 0 || errno == EINTR || errno == EAGAIN;
      const auto left = std::chrono::ceil<milliseconds>(end - steady_clock::now());
      if (may_go_on && left.count() > 0 && (size > 0 || becomes(output_, POLLOUT, left))) continue;
      lost_ = true;
      return;
    }
  }

  bool is_lost() const noexcept { return lost_; }

  /// The next word; empty where none comes within `limit`, or before `interruption` is readable.
  std::string hear(milliseconds limit, int interruption = -1) {
    const auto end = steady_clock::now() + limit;
    while (words_.empty()) {
      const auto left = std::chrono::ceil<milliseconds>(end - steady_clock::now()).count();
      std::array<pollfd, 2> watched{{{input_, POLLIN, 0}, {interruption, POLLIN, 0}}};
      if (left <= 0) return "";
      const int ready = ::poll(watched.data(), watched.size(), static_cast<int>(left));
      if (ready == 0) return "";
      if (ready < 0) continue;  // a signal
      if (watched[1].revents != 0) return "";
      std::array<char, 4096> buffer;
      const auto size = ::read(input_, buffer.data(), buffer.size());
      if (size < 0 && errno == EINTR) continue;
      if (size <= 0) return "";
      lines_.add({buffer.data(), static_cast<std::size_t>(size)},
                 [&](std::string_view line) { words_.emplace_back(line); });
    }
    std::string word = std::move(words_.front());
    words_.erase(words_.begin());
    return word;
  }

 private:
  const int input_;
  const int output_;
  std::atomic<bool> lost_{false};
  LineSplitter lines_;
  std::vector<std::string> words_;
};

/// Listens in a thread of its own, and ends the mission when it should not go on.
class Attendance {
 public:
  Attendance(Attendant& attendant, Supervisor& supervisor)
      : thread_([this, &attendant, &supervisor] { listen(attendant, supervisor); }) {}
  Attendance(const Attendance&) = delete;
  Attendance& operator=(const Attendance&) = delete;
  ~Attendance() { end(); }

  /// The mission has ended. Whether it was this that ended it, for want of an attendant.
  bool end() {
    over_.raise();
    if (thread_.joinable()) thread_.join();
    return is_lonely_;
  }

 private:
  void listen(Attendant& attendant, Supervisor& supervisor) {
    std::string word;
    do {
      word = attendant.hear(kAttendancePatience, over_.descriptor());
    } while (word == kAlive && !attendant.is_lost());
    if (becomes(over_.descriptor(), POLLIN, milliseconds(0))) return;
    is_lonely_ = word != kStop;
    supervisor.request_stop();
    if (word == kStop) return;
    // The kernel and the guard kill with this process whatever it has started.
    if (!becomes(over_.descriptor(), POLLIN, kLonelyGrace)) ::_exit(kPeerLost);
  }

  StopRequest over_;
  std::atomic<bool> is_lonely_{false};
  std::thread thread_;
};

void leave_signals_to_supervisor() {
  sigset_t signals = ending_signals();
  sigaddset(&signals, SIGCHLD);  // for the supervisor's thread alone, which unblocks it
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  ::signal(SIGPIPE, SIG_IGN);
}

}  // namespace

int run_attended(LaunchPlan plan, SupervisorOptions options, const std::string& hello, int input,
                 int output) {
  using Kind = AttendedReport::Kind;
  leave_signals_to_supervisor();
  Attendant attendant(input, output);
  attendant.tell({.kind = Kind::Hello, .text = hello});
  if (attendant.hear(kHelloPatience) != kGo) return kStartFailed;

  plan.mission_elsewhere.clear();  // it ends this one
  const std::size_t count = plan.children.size();
  std::set<std::string> vital;  // whose loss ends the mission
  for (const ChildPlan& child : plan.children) {
    if (child.rules.on_loss == profile::LossPolicy::Abort) vital.insert(child.name);
  }
  std::set<std::string> begun;  // are ready, or will never be
  options.on_output = [&](std::string_view child, std::string_view line) {
    attendant.tell({.kind = Kind::Output, .child = std::string(child), .text = std::string(line)});
  };
  options.on_event = [&](const ChildEvent& event) {
    attendant.tell(
        {.kind = Kind::Event, .child = event.child, .state = event.state, .text = event.text});
    const bool settled = event.state == ChildState::Ready || event.state == ChildState::Ended ||
                         (event.state == ChildState::Lost && !vital.contains(event.child));
    if (event.child.empty() || !settled || !begun.insert(event.child).second) return;
    if (begun.size() == count) attendant.tell({.kind = Kind::Ready});
  };
  Supervisor supervisor(std::move(plan), std::move(options));
  Attendance attendance(attendant, supervisor);
  LaunchResult result = supervisor.run();
  if (attendance.end()) {
    result.exit_code = kPeerLost;
    result.reason = "it hears nothing more of the launcher that attends it";
  }
  attendant.tell({.kind = Kind::Ended, .exit_code = result.exit_code, .text = result.reason});
  return result.exit_code;
}

}  // namespace skein::launch
