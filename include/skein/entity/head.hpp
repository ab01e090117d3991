#pragma once

#include <memory>
#include <string>
#include <vector>

#include "skein/connector/connector.hpp"
#include "skein/entity/decision.hpp"
#include "skein/entity/head_options.hpp"
#include "skein/entity/task_run.hpp"
#include "skein/rpc/service.hpp"

namespace skein {

/// No CSP stands by for the task.
class NoCandidate : public Unavailable {
 public:
  using Unavailable::Unavailable;
};

/// CSPs answered, but every result was rejected, or those that were accepted do not agree.
class NoneAccepted : public Internal {
 public:
  using Internal::Internal;
};

/// The deciding half of an entity: which CSPs run a task, whether their results are good enough,
/// what is made of several, and what to do when one fails. Candidates are what the Broker knows of
/// the managed interface at that moment, so CSPs come and go while the system runs. A CSP that
/// fails again and again is kept in quarantine (CircuitBreaker), what each one took and achieved is
/// remembered (History). Thread-safe.
///
/// CSPs in this process have threads of their own, so that one that hangs holds up nobody. Only one
/// that has never been late, and of whose last twelve like runs half took HeadOptions::quick at
/// most, runs its blocking calls on the thread of the Body that performs, if the task has 100 ms or
/// more left and runs one CSP at a time. Should it hang all the same, the Head writes that thread
/// off at the task's deadline: the caller is told TimedOut, a spare takes over the Body's service,
/// the CSP is quarantined and has its own thread for good. A thread that comes back after that is
/// parked, and nothing of the Body runs on it any more: a Body holds no lock while it performs.
class Head {
 public:
  struct Current {
    std::string csp;
    std::uint32_t pid = 0;
    std::string host;
  };

  /// What a Head works with; all of it outlives the Head.
  struct Parts {
    Connector& connector;
    brokerless_discovery::Broker& broker;
    std::shared_ptr<rpc::LocalDirectory> directory;
    Clock& clock;
    dds::Participant& participant;
    Executor& control;
    std::string entity;  ///< `system/name`
  };

  /// Throws InvalidArgument for an unknown strategy, a history that cannot be read, a log that
  /// cannot be written.
  Head(const Parts& parts, HeadOptions options);
  /// Writes the history.
  ~Head();

  /// Makes a strategy selectable by its name; see StrategyFactory.
  void add_strategy(std::shared_ptr<const SelectionStrategy> strategy);

  /// A session for a client that connects (the paper's `initialize()`). Throws InvalidArgument for
  /// an unknown strategy, with the known ones.
  std::shared_ptr<Session> initialize(const rpc::OpenRequest& request) const;

  /// Runs the task on the CSPs that the session's strategy selects, until enough results are
  /// accepted and make one; where one fails, the next best follows while time is left. Never waits
  /// for the slowest: what still works then is cancelled. The time limit is the current call's
  /// deadline, `limit` outside of any call; the answer is there by then even where every CSP hangs.
  /// Throws NoCandidate; TimedOut where time ran out; NoneAccepted; otherwise what the last attempt
  /// threw. `record` receives the decision, also when this throws.
  template <class Interface, class Result>
  Result perform(const Task<Interface, Result>& task, DecisionRecord* record = nullptr,
                 Duration limit = std::chrono::seconds(60)) {
    task_run::TypedRun<Interface, Result> run(task);
    decide(Interface::interface_info(), run, limit, record);
    return run.take();
  }

  /// A proxy of the CSP that the session's strategy selects now, for a Body that calls it directly:
  /// the choice is recorded, but nothing is evaluated or done again, nor known of its calls.
  /// `limit` is the proxy's. Throws as perform() does.
  template <class Interface>
  typename Interface::Proxy preselect(const Features& features = {},
                                      Duration limit = std::chrono::seconds(5)) {
    return
        typename Interface::Proxy(preselect(Interface::interface_info(), features, limit), limit);
  }

  /// The CSPs that work for this Head now.
  std::vector<Current> running() const;

  /// The last decisions, oldest first; 64 are kept. `skein decisions` shows those of all entities
  /// as they are made.
  std::vector<DecisionRecord> decisions() const;

  /// As it is now.
  History history() const;

  /// Whether so many CSPs in this process do not return that the process should be restarted.
  bool degraded() const;

 private:
  struct State;
  class Run;

  DecisionRecord open_record(const InterfaceInfo& interface, const SelectionStrategy& strategy,
                             const Features& features, Instant begin, Duration limit) const;
  void decide(const InterfaceInfo& interface, task_run::TaskRun& task, Duration limit,
              DecisionRecord* wanted);
  std::shared_ptr<Channel> preselect(const InterfaceInfo& interface, const Features& features,
                                     Duration limit);

  std::unique_ptr<State> state_;
};

}  // namespace skein
