#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "skein/connector.hpp"
#include "skein/detail/history.hpp"
#include "skein/detail/task_run.hpp"
#include "skein/entity.hpp"
#include "skein/error.hpp"
#include "skein/selection.hpp"
#include "skein/task.hpp"

namespace skein::rpc {
struct OpenRequest;
}

namespace skein {

/// No CSP is available for the task.
class NoCandidate : public Unavailable {
 public:
  using Unavailable::Unavailable;
};

/// CSPs answered, but their results were rejected, or the accepted ones do not agree.
class NoneAccepted : public Internal {
 public:
  using Internal::Internal;
};

/// The deciding part of an entity: it selects the CSPs that run a task, evaluates their results,
/// makes one result from several, and falls back to other CSPs on failure. The candidates are the
/// CSPs that the Broker knows at that moment, so CSPs may come and go while the system runs. A CSP
/// that fails repeatedly is quarantined (CircuitBreaker), which is logged with the reason, once for
/// each cause; so is that a CSP in this process does not return. The time and the quality of each
/// CSP are remembered (History). Thread-safe.
///
/// A CSP in this process runs on the thread that it declares (ServiceOptions::thread). If it hangs
/// on a thread of its own, the Head continues at the end of its time slice, and does not call it
/// again until it has returned. On the caller's thread a blocking call takes less than a
/// microsecond, but the Head waits until it returns: use this only for calls that are bounded by
/// construction.
/// A Body has a task done, and tells a failure in its interface's words:
///
/// ```cpp
/// try {
///   return head_.perform(task);
/// } catch (const skein::NoneAccepted& refusal) {
///   throw survey::NoTrack(refusal.what());
/// }
/// ```
class Head {
 public:
  struct Current {
    std::string csp;
    std::uint32_t pid = 0;
    std::string host;  ///< As in its description.
  };

  struct Parts;

  /// Used by Entity, with EntityOptions::head. Throws InvalidArgument for an unknown strategy, for
  /// a history that cannot be read, and for a log that cannot be written.
  Head(const Parts& parts, HeadOptions options);
  /// Writes the history; logs an error if it cannot.
  ~Head();

  /// Makes a strategy selectable by its name; see StrategyFactory::add().
  void add_strategy(std::shared_ptr<const SelectionStrategy> strategy);

  /// Used when a client connects: makes its session (the paper's `initialize()`). Throws
  /// InvalidArgument for an unknown strategy; the text lists the known ones.
  std::shared_ptr<Session> initialize(const rpc::OpenRequest& request) const;

  /// Runs the task on the CSPs that the session's strategy selects, until enough results are
  /// accepted and one result is made from them. If a CSP fails, the next best follows while time is
  /// left. CSPs that still work at the end are cancelled. The time limit is `limit`, or the
  /// deadline of the current call less 3 ms if that is sooner; it holds even if every CSP hangs
  /// (but see CallThread::Caller).
  ///
  /// What one of the task's own functions or the strategy throws is told as theirs (`the check
  /// 'map' threw: no map`), and no CSP is charged for it. It is thrown on as Internal; an Error
  /// keeps its class, a UserException its type. After `run`, `evaluate`, `quality` and `settles`
  /// the next best CSP follows first.
  ///
  /// Throws InvalidArgument for a task that cannot work; NoCandidate; NoneAccepted if the last
  /// result was rejected or the accepted ones do not agree; TimedOut if there was no time to ask a
  /// CSP; otherwise the error of the last attempt. `record` receives the decision, also if this
  /// throws.
  template <class Interface, class Result>
  Result perform(const Task<Interface, Result>& task, introspection::Decision* record = nullptr,
                 TimeSpan limit = std::chrono::seconds(60)) {
    return perform(Interface::interface_info(), task, record, limit);
  }
  /// For an interface that is known at run time alone; `Interface` has its Proxy.
  template <class Interface, class Result>
  Result perform(const InterfaceInfo& interface, const Task<Interface, Result>& task,
                 introspection::Decision* record, TimeSpan limit) {
    task_run::TypedRun<Interface, Result> run(task);
    decide(interface, run, limit, record);
    return run.take();
  }

  /// A proxy of the CSP that the session's strategy selects now, for a Body that calls it directly.
  /// The choice is recorded, also if this throws; the calls are neither evaluated nor retried nor
  /// recorded. `limit` is the proxy's timeout. Throws NoCandidate, or the error of opening the
  /// connection.
  template <class Interface>
  typename ProxyOf<Interface>::type preselect(const Features& features = {},
                                              TimeSpan limit = std::chrono::seconds(5)) {
    return
        typename Interface::Proxy(preselect(Interface::interface_info(), features, limit), limit);
  }

  /// The CSPs that work for this Head now.
  std::vector<Current> running() const;

  /// The last 64 decisions, oldest first. `skein decisions` shows those of all entities live.
  std::vector<introspection::Decision> decisions() const;

  /// A copy of the current history.
  History history() const;

  /// Whether HeadOptions::max_stuck or more CSPs in this process do not return, so that the process
  /// should be restarted.
  bool degraded() const;

 private:
  struct State;
  class Run;

  introspection::Decision open_record(const InterfaceInfo& interface,
                                      const SelectionStrategy& strategy, const TaskOptions& task,
                                      Instant begin, Duration limit) const;
  void decide(const InterfaceInfo& interface, task_run::TaskRun& task, Duration limit,
              introspection::Decision* wanted);
  std::shared_ptr<Channel> preselect(const InterfaceInfo& interface, const Features& features,
                                     Duration limit);

  std::unique_ptr<State> state_;
};

}  // namespace skein
