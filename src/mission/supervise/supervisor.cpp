#include "mission/supervise/supervisor.hpp"

#include <poll.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <optional>
#include <vector>

#include "adopted_processes.hpp"
#include "core/printable.hpp"
#include "core/suggestion.hpp"
#include "core/wall_clock.hpp"
#include "mission/process/request_server.hpp"
#include "mission/process/wake_up.hpp"
#include "mission/supervise/mission_claim.hpp"
#include "mission/supervise/mission_state.hpp"
#include "recent_lines.hpp"
#include "skein/detail/type_support.hpp"
#include "skein/mission_status.idl.hpp"
#include "supervised_child.hpp"

namespace skein::launch {
namespace {

Time now() { return std::chrono::steady_clock::now(); }

constexpr const char* kOpenEnd =
    "; the peer that runs the mission is not among them: this launcher runs until it is "
    "interrupted "
    "or all of its "
    "processes have ended";

/// The process of a CSP is PEER/CSP here, PEER.CSP among entities, and CSP where nobody else has
/// that name.
std::optional<std::size_t> process_named(std::string_view asked,
                                         const std::vector<std::string>& names) {
  std::string name(asked);
  std::ranges::replace(name, '.', '/');
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == asked) return i;
    if (names[i] == name || names[i].ends_with("/" + name)) found.push_back(i);
  }
  return found.size() == 1 ? std::optional(found.front()) : std::nullopt;
}

std::string accepted(const std::string& text) { return std::string(kAccepted).append(text); }
std::string refused(const std::string& text) { return std::string(kRefused).append(text); }

/// One run of a mission, from the start of its processes to the end of the last one.
class MissionRun {
 public:
  MissionRun(const LaunchPlan& plan, const SupervisorOptions& options, StopRequest& stop)
      : plan_(plan), options_(noted(options)), stop_(stop), state_(plan) {
    for (std::size_t i = 0; i < plan.children.size(); ++i)
      children_.emplace_back(plan.children[i], state_.child(i), options_, guard_);
  }

  LaunchResult run() {
    heed_signals();
    if (!result_) apply(state_.start(now()));
    while (!state_.all_final()) {
      wait();
      for (std::size_t i = 0; i < children_.size(); ++i) look_at(i);
      adopted_.reap([this](pid_t process) { return is_awaited(process); });
      apply(state_.tick(now()), true);
      serve_requests();
      heed_signals();
    }
    note_verdict();
    return *result_;
  }

 private:
  using Steps = MissionState::Steps;

  SupervisorOptions noted(SupervisorOptions options) {
    options.on_output = [this, tell = std::move(options.on_output)](std::string_view child,
                                                                    std::string_view line) {
      note(std::string(child), true, line);
      tell(child, line);
    };
    options.on_event = [this, tell = std::move(options.on_event)](const ChildEvent& event) {
      note(event.child, false, event.text);
      tell(event);
    };
    return options;
  }

  void note(const std::string& process, bool printed, std::string_view text) {
    const auto child = std::ranges::find(plan_.children, process, &ChildPlan::name);
    recent_.add(nanoseconds_since_1970(), process,
                child == plan_.children.end() ? "" : child->system, printed, text);
  }

  /// Whether collect() waits for this child, since its exit status counts.
  bool is_awaited(pid_t process) const {
    return std::ranges::any_of(children_, [&](const SupervisedChild& child) {
      return child.process() != nullptr && child.process()->id() == process;
    });
  }

  void report(const std::string& text) const { options_.on_event({"", ChildState::Idle, text}); }

  void look_at(std::size_t i) {
    SupervisedChild& child = children_[i];
    child.read_output();
    heed_signs(i);
    const auto status = child.collect();
    if (!status) return;
    heed_signs(i);
    const bool fault = !state_.verdict() && (status->failed() || child_of(i).hang() != Hang::None);
    const auto steps = state_.exited(i, status->failed(), now(), child.is_misconfigured());
    child.tell_end();
    if (fault) note_fault(i, child.plan().name + " " + child.end_text() + child.last_reason());
    tell_loss(i);
    apply(steps);
    tell_settled();
  }

  const ChildStateMachine& child_of(std::size_t i) const { return state_.child(i); }

  /// Also of a child that has ended: what it said before counts.
  void heed_signs(std::size_t i) {
    const Signs signs = children_[i].read_signs();
    if (signs.ready && child_of(i).state() == ChildState::Starting) {
      const Time when = now();
      const auto steps = state_.ready(i, when);
      children_[i].tell_ready(when);
      tell_settled();
      apply(steps);
    }
    if (signs.progress) apply(state_.progress(i, now()));
  }

  void tell_settled() {
    if (told_settled_ || state_.verdict() || !state_.all_settled()) return;
    told_settled_ = true;
    const std::size_t ready = state_.ready_count();
    const bool all = ready == children_.size();
    report((all ? "all " : std::to_string(ready) + " of ") + std::to_string(children_.size()) +
           " processes are ready after " + seconds_text(now() - start_) +
           (all ? "" : "; the others have ended") +
           (plan_.mission_elsewhere.empty() ? "" : kOpenEnd));
  }

  void tell_loss(std::size_t i) const {
    const ChildPlan& plan = children_[i].plan();
    if (child_of(i).state() == ChildState::Lost && !plan.runs_mission && !state_.verdict() &&
        plan.rules.on_loss == profile::LossPolicy::Degrade)
      report("goes on degraded, without " + plan.name);
  }

  void note_fault(std::size_t i, const std::string& what) {
    if (faults_++ > 0) return;
    first_fault_ = "after " + seconds_text(now() - start_) + ", " + what;
    first_faulty_ = i;
  }

  /// Does what the machines want, and what follows from it. `overdue`: as time ran out.
  void apply(Steps steps, bool overdue = false) {
    note_verdict();
    for (std::size_t at = 0; at < steps.size(); ++at) {
      const auto [i, action] = steps[at];
      if (action != ChildAction::Spawn) {
        children_[i].send(action, overdue);
        continue;
      }
      // Whoever was to be started when the mission's end came is not.
      const bool wanted = child_of(i).state() == ChildState::Starting;
      if (wanted && children_[i].spawn(now())) {
        if (!children_[i].plan().tells_ready) heed_signs(i);
        continue;
      }
      const bool passing = wanted && children_[i].spawn_may_succeed_later();
      const auto more = state_.spawn_failed(i, passing, now());
      steps.insert(steps.end(), more.begin(), more.end());
      if (!wanted) continue;
      children_[i].tell_spawn_failed();
      note_fault(i, children_[i].spawn_fault());
      tell_loss(i);
      note_verdict();
      tell_settled();
    }
  }

  /// The first cause counts; what follows from it does not.
  void note_verdict() {
    if (result_ || !state_.verdict()) return;
    result_ = result_of(*state_.verdict());
    if (result_->exit_code == 0 && state_.is_degraded()) {
      result_->exit_code = kDegraded;
    }
    using End = MissionState::End;
    const auto [end, child] = *state_.verdict();
    const bool is_the_reason =
        faults_ == 1 && child == first_faulty_ && (end == End::Lost || end == End::MissionEnded);
    if (!is_the_reason) result_->first_fault = first_fault_;
    report("ends: " + result_->reason);
  }

  LaunchResult result_of(const MissionState::Verdict& verdict) const {
    switch (verdict.end) {
      case MissionState::End::MissionEnded: {
        const SupervisedChild& child = children_[verdict.child];
        return {child.last_status()->exit_code(),
                child.plan().name + ", which runs the mission, " + child.end_text() +
                    child.last_reason(),
                ""};
      }
      case MissionState::End::Lost: {
        if (children_[verdict.child].is_misconfigured()) {
          return {kConfigurationError, children_[verdict.child].loss(), ""};
        }
        const bool started = child_of(verdict.child).was_ready();
        return {started ? kPeerLost : kStartFailed, children_[verdict.child].loss(), ""};
      }
      case MissionState::End::Stopped:
        return {kInterrupted + signal_, stop_reason_, ""};
      case MissionState::End::AllEnded:
        break;
    }
    for (const SupervisedChild& child : children_) {
      if (!child.loss().empty()) return {kPeerLost, child.loss(), ""};
    }
    return {0, "all processes have ended", ""};
  }

  void stop(int signal, const std::string& reason) {
    signal_ = signal;
    stop_reason_ = reason;
    apply(state_.stop(now()));
  }

  void heed_signals() {
    if (stop_.take() && !state_.verdict()) stop(SIGTERM, "it was asked to stop");
    for (auto signal = signals_.take(); signal.number != 0; signal = signals_.take()) {
      if (signal.number == signal_ && now() - signalled_ < kSameSignal) continue;
      signalled_ = now();
      stop(signal.number,
           "interrupted by signal " + std::to_string(signal.number) + " (" +
               ::sigdescr_np(signal.number) + ")" +
               (signal.sender == 0 ? ""
                                   : ", which process " + std::to_string(signal.sender) + " sent"));
    }
  }

  void serve_requests() {
    if (!options_.requests) return;
    requests_due_ = options_.requests->serve(
        now(), [this](std::string_view request) { return answer(request); });
  }

  std::string answer(std::string_view request) {
    const std::string_view verb = request.substr(0, request.find(' '));
    const std::string_view rest = request.substr(std::min(verb.size() + 1, request.size()));
    if (request == "status") return accepted(status());
    if (request == "lines") return accepted(recent_.json());
    if (request == "stop") {
      stop_.raise();
      return accepted("the mission is being ended");
    }
    if (verb == "restart") return with_process(rest, [&](std::size_t i) { return restart(i); });
    if (verb == "kill") return with_process(rest, [&](std::size_t i) { return kill(i); });
    if (verb == "hang") return with_process(rest, [&](std::size_t i) { return hang(i); });
    return refused("it does not know this request; is it of another version?");
  }

  std::string restart(std::size_t i) {
    const std::string& name = children_[i].plan().name;
    if (child_of(i).state() == ChildState::Idle) return refused(name + " was not started yet");
    report("is asked to start " + name + " anew");
    apply(state_.restart(i, now()));
    return accepted(name + " is started anew");
  }

  std::string kill(std::size_t i) { return fault(i, SIGKILL, "is killed"); }

  std::string hang(std::size_t i) {
    return fault(i, SIGSTOP, "hangs from now on; restart it to go on");
  }

  /// What a mission must bear, on demand.
  std::string fault(std::size_t i, int signal, const std::string& effect) {
    const std::string& name = children_[i].plan().name;
    const ChildProcess* process = children_[i].process();
    if (!process) return refused(name + " does not run");
    report(name + " " + effect + ", as somebody asks");
    process->send(signal);
    return accepted(name + " " + effect);
  }

  /// What `act` answers for the process of that name, or why there is none.
  template <class Act>
  std::string with_process(std::string_view asked, const Act& act) const {
    std::vector<std::string> names;
    for (const SupervisedChild& child : children_) names.push_back(child.plan().name);
    if (const auto i = process_named(asked, names))
      return state_.verdict() ? refused("the mission is being ended") : act(*i);
    const std::string unknown = printable(asked);
    std::string list;
    for (const std::string& each : names) list += (list.empty() ? "" : ", ") + each;
    return refused("the mission has no process '" + unknown + "' here" +
                   suggestion(unknown, names) + "; it has " + list);
  }

  std::string status() const {
    MissionStatus status;
    const Time when = now();
    status.mission = plan_.mission;
    status.domain = static_cast<std::uint32_t>(plan_.domain);
    status.launcher = static_cast<std::uint32_t>(::getpid());
    status.uptime = std::chrono::duration<double>(when - start_).count();
    status.degraded = state_.is_degraded();
    status.ending = result_ ? result_->reason : "";
    for (const SupervisedChild& child : children_) status.processes.push_back(child.status(when));
    status.elsewhere = plan_.elsewhere;
    return idl::to_json(status);
  }

  void wait() {
    std::vector<pollfd> watched{{stop_.descriptor(), POLLIN, 0},
                                {signals_.descriptor(), POLLIN, 0},
                                {adopted_.descriptor(), POLLIN, 0}};
    if (options_.requests) watched.push_back({options_.requests->descriptor(), POLLIN, 0});
    for (const auto& child : children_) {
      auto* process = child.process();
      if (process == nullptr) continue;
      for (const int descriptor :
           {process->end_descriptor(), process->output().get(), process->readiness().get()}) {
        watched.push_back({descriptor, POLLIN, 0});  // A closed one is -1, which poll() ignores.
      }
    }
    using std::chrono::milliseconds;
    auto due = state_.next_tick();
    if (requests_due_) due = due ? std::min(*due, *requests_due_) : requests_due_;
    const auto left = due ? std::chrono::ceil<milliseconds>(*due - now()) : milliseconds(-1);
    const auto limit =
        due ? std::clamp<std::int64_t>(left.count(), 0, kLongestWaitMs) : kLongestWaitMs;
    ::poll(watched.data(), watched.size(), static_cast<int>(limit));
  }

  static constexpr std::int64_t kLongestWaitMs = 60'000;
  // timeout(1) sends its signal to the process, and at once to its group.
  static constexpr std::chrono::milliseconds kSameSignal{300};

  const LaunchPlan& plan_;
  RecentLines recent_;
  const SupervisorOptions options_;  // as they were given, and each line is noted
  StopRequest& stop_;
  SignalReader signals_;
  GroupGuard guard_;
  AdoptedProcesses adopted_;  // Between the guard, which it spares, and children_, which end first.
  const Time start_ = now();
  MissionState state_;
  std::vector<SupervisedChild> children_;
  std::optional<Time> requests_due_;
  std::optional<LaunchResult> result_;
  std::size_t faults_ = 0;
  std::string first_fault_;
  std::size_t first_faulty_ = 0;
  std::string stop_reason_;
  int signal_ = 0;
  Time signalled_{};
  bool told_settled_ = false;
};

}  // namespace

struct Supervisor::State {
  const LaunchPlan plan;
  const SupervisorOptions options;
  StopRequest stop{};
};

Supervisor::Supervisor(LaunchPlan plan, SupervisorOptions options)
    : state_(new State{std::move(plan), std::move(options)}) {}

Supervisor::~Supervisor() = default;

LaunchResult Supervisor::run() {
  return MissionRun(state_->plan, state_->options, state_->stop).run();
}

void Supervisor::request_stop() noexcept { state_->stop.raise(); }

}  // namespace skein::launch
