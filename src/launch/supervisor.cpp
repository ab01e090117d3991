#include "launch/supervisor.hpp"

#include <poll.h>
#include <sys/prctl.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <optional>
#include <vector>

#include "supervised_child.hpp"
#include "wake_up.hpp"

namespace skein::launch {
namespace {

Time now() { return std::chrono::steady_clock::now(); }

/// While it lives, this process can wait for its children and for theirs: orphans come to it
/// instead of to init, and SIGCHLD is not ignored, as a parent may have left it.
class ChildKeeping {
 public:
  ChildKeeping() {
    ::prctl(PR_GET_CHILD_SUBREAPER, &adopted_before_);
    ::prctl(PR_SET_CHILD_SUBREAPER, 1);
    struct sigaction standard {};
    standard.sa_handler = SIG_DFL;
    ::sigaction(SIGCHLD, &standard, &action_before_);
  }
  ChildKeeping(const ChildKeeping&) = delete;
  ChildKeeping& operator=(const ChildKeeping&) = delete;
  ~ChildKeeping() {
    ::sigaction(SIGCHLD, &action_before_, nullptr);
    ::prctl(PR_SET_CHILD_SUBREAPER, adopted_before_);
  }

 private:
  int adopted_before_ = 0;
  struct sigaction action_before_ {};
};

constexpr std::size_t kNameColumn = 22;

void print_line(std::FILE* stream, std::string_view name, std::string_view separator,
                std::string_view text) {
  std::string line(name);
  if (line.size() < kNameColumn) line.resize(kNameColumn, ' ');
  line.append(separator).append(text).append("\n");
  std::fwrite(line.data(), 1, line.size(), stream);
  std::fflush(stream);
}

constexpr const char* kOpenEnd =
    "; the mission runs on another host: this launcher runs until it is interrupted or all of its "
    "processes have ended";

std::size_t count_ready(const std::vector<SupervisedChild>& children) {
  return static_cast<std::size_t>(std::count_if(
      children.begin(), children.end(),
      [](const SupervisedChild& child) { return child.machine().state() == ChildState::Ready; }));
}

SupervisorOptions with_defaults(SupervisorOptions options) {
  if (!options.on_output) {
    options.on_output = [](std::string_view child, std::string_view line) {
      print_line(stdout, child, " | ", line);
    };
  }
  if (!options.on_event) {
    options.on_event = [](const ChildEvent& event) {
      print_line(stderr, event.child.empty() ? "mission" : event.child, " * ", event.text);
    };
  }
  return options;
}

/// One run of a mission, from the start of its processes to the end of the last one.
class MissionRun {
 public:
  MissionRun(const LaunchPlan& plan, const SupervisorOptions& options, StopRequest& stop)
      : plan_(plan), options_(options), stop_(stop), signals_(options.handle_signals) {
    for (const auto& child : plan.children) children_.emplace_back(child, options_, guard_);
  }

  LaunchResult run() {
    const Time start = now();
    heed_requests();
    for (auto& child : children_) {
      if (!result_) child.start(now());
    }
    while (true) {
      judge(start);
      if (all_final()) break;
      wait();
      for (auto& child : children_) {
        child.read_output();
        child.read_readiness(now());
        child.collect(now());
        child.tick(now());
      }
      heed_requests();
    }
    if (!result_) end(all_ended());
    return *result_;
  }

 private:
  void report(const std::string& text) const { options_.on_event({"", ChildState::Idle, text}); }

  bool all_final() const {
    return std::all_of(children_.begin(), children_.end(),
                       [](const SupervisedChild& child) { return child.machine().is_final(); });
  }

  /// The first cause counts; what follows from it does not.
  void end(LaunchResult result) {
    if (result_) return;
    result_ = std::move(result);
    report("ends: " + result_->reason);
    for (auto& child : children_) child.stop(now());
  }

  void interrupt(int signal) {
    if (result_) {
      for (auto& child : children_) child.stop(now());
    }
    end({Outcome::Interrupted, kInterrupted + signal,
         "interrupted by signal " + std::to_string(signal) + " (" + ::sigdescr_np(signal) + ")"});
  }

  void heed_requests() {
    if (stop_.take()) {
      end({Outcome::Interrupted, kInterrupted + SIGTERM, "it was asked to stop"});
    }
    while (const int signal = signals_.take()) interrupt(signal);
  }

  void judge(Time start) {
    if (!all_ready_ && !result_ && count_ready(children_) == children_.size()) {
      all_ready_ = true;
      report("all " + std::to_string(children_.size()) + " processes are ready after " +
             seconds_text(now() - start) + (plan_.mission_elsewhere.empty() ? "" : kOpenEnd));
    }
    for (const auto& child : children_) {
      if (!result_ && child.machine().is_final()) judge(child);
    }
  }

  void judge(const SupervisedChild& child) {
    const bool lost = child.machine().state() == ChildState::Lost;
    const auto& status = child.last_status();
    if (child.plan().runs_mission && status && !child.hung_at_start()) {
      end({Outcome::MissionEnded, status->exit_code(),
           child.plan().name + ", which runs the mission, ended " + to_text(*status) +
               child.last_reason()});
    } else if (lost && (child.plan().required || child.plan().runs_mission)) {
      const bool started = child.machine().was_ready();
      end({started ? Outcome::PeerLost : Outcome::StartFailed, started ? kPeerLost : kStartFailed,
           child.loss()});
    }
  }

  /// Without a peer that runs the mission: all processes came to their end.
  LaunchResult all_ended() const {
    for (const auto& child : children_) {
      if (!child.loss().empty()) return {Outcome::PeerLost, kPeerLost, child.loss()};
    }
    return {Outcome::MissionEnded, 0, "all processes have ended"};
  }

  void wait() {
    std::vector<pollfd> watched{{stop_.descriptor(), POLLIN, 0},
                                {signals_.descriptor(), POLLIN, 0}};
    std::optional<Time> due;
    for (const auto& child : children_) {
      if (const auto tick = child.machine().next_tick()) due = due ? std::min(*due, *tick) : *tick;
      auto* process = child.process();
      if (process == nullptr) continue;
      for (const int descriptor :
           {process->end_descriptor(), process->output().get(), process->readiness().get()}) {
        watched.push_back({descriptor, POLLIN, 0});  // A closed one is -1, which poll() ignores.
      }
    }
    using std::chrono::milliseconds;
    const auto left = due ? std::chrono::ceil<milliseconds>(*due - now()) : milliseconds(-1);
    const auto limit = due ? std::clamp<std::int64_t>(left.count(), 0, kLongestWaitMs) : -1;
    ::poll(watched.data(), watched.size(), static_cast<int>(limit));
  }

  static constexpr std::int64_t kLongestWaitMs = 60'000;

  const LaunchPlan& plan_;
  const SupervisorOptions& options_;
  StopRequest& stop_;
  SignalReader signals_;
  const ChildKeeping child_keeping_;
  GroupGuard guard_;
  std::vector<SupervisedChild> children_;
  std::optional<LaunchResult> result_;
  bool all_ready_ = false;
};

}  // namespace

class Supervisor::Implementation {
 public:
  Implementation(LaunchPlan plan, SupervisorOptions options)
      : plan_(std::move(plan)), options_(with_defaults(std::move(options))) {}

  LaunchResult run() { return MissionRun(plan_, options_, stop_).run(); }
  void request_stop() noexcept { stop_.raise(); }

 private:
  LaunchPlan plan_;
  SupervisorOptions options_;
  StopRequest stop_;
};

Supervisor::Supervisor(LaunchPlan plan, SupervisorOptions options)
    : implementation_(std::make_unique<Implementation>(std::move(plan), std::move(options))) {}

Supervisor::~Supervisor() = default;

LaunchResult Supervisor::run() { return implementation_->run(); }

void Supervisor::request_stop() noexcept { implementation_->request_stop(); }

}  // namespace skein::launch
