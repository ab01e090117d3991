#pragma once

#include <exception>
#include <map>
#include <mutex>
#include <unordered_map>

#include "brokerless_discovery/broker.hpp"
#include "core/recent_set.hpp"
#include "csp_channels.hpp"
#include "head_learning.hpp"
#include "head_warnings.hpp"
#include "kept_decisions.hpp"
#include "lost_csps.hpp"
#include "rpc/service/service.hpp"
#include "selection/wire_values.hpp"
#include "session_strategies.hpp"

namespace skein {

/// What a Head holds from one request to the next. Thread-safe.
struct Head::State {
  State(const Parts& parts, HeadOptions options);
  ~State();

  /// Those that are available; perhaps none.
  std::vector<Candidate> candidates(const InterfaceInfo& interface, const TaskOptions& task,
                                    const SelectionStrategy& strategy, Instant now);
  /// The same; where there is none, waits for a CSP that died to come back, until `deadline`.
  std::vector<Candidate> await_candidates(const InterfaceInfo& interface, const TaskOptions& task,
                                          const SelectionStrategy& strategy, Instant deadline);
  /// Waits for the Broker's next change after `seen` while a CSP that died may come back, until
  /// `deadline`. False where there was none.
  bool await_change(const InterfaceInfo& interface, const entity::LostCsps& lost,
                    std::uint64_t seen, Instant deadline) const;
  /// Throws NoCandidate: there is none.
  [[noreturn]] void refuse_without(const InterfaceInfo& interface, const std::string& only);

  /// A CSP begins to work: the number of its run. Nothing, and nothing happens, where it has been
  /// quarantined since it was listed.
  std::optional<std::uint64_t> begin(const InterfaceInfo& interface, const Candidate& candidate,
                                     Instant now);
  /// What came of it: for the breaker, the history, and whoever is told of hangs.
  void end(const InterfaceInfo& interface, const Candidate& candidate,
           const std::shared_ptr<const Features>& features, std::uint64_t run,
           const entity::Ending& ending);
  /// Runs `decide()`, which fills the record, and concludes that, also where it throws.
  template <class Decide>
  void record(introspection::Decision& record, Instant begin, introspection::Decision* wanted,
              Decide decide);
  /// Numbers the decision, keeps it and tells of it; a copy to whom `wanted` belongs, if anybody.
  void conclude(introspection::Decision&& record, introspection::Decision* wanted = nullptr);
  /// While it lives this thread may run a CSP, and then cannot say itself that it does not return:
  /// that is logged after `end`, at most a second later.
  class Watch {
   public:
    Watch(State& state, const InterfaceInfo& interface, const Candidate& candidate, Instant end);
    ~Watch();
    Watch(const Watch&) = delete;
    Watch& operator=(const Watch&) = delete;

   private:
    friend State;
    State& state_;
    const std::string_view interface_;
    const Candidate& candidate_;
    const Instant end_;
  };
  std::size_t count_stuck();

  /// A CSP as its description tells of it.
  struct Known {
    Candidate candidate;
    std::shared_ptr<const std::string> host;  ///< Where it lives.
    std::weak_ptr<rpc::Service> service;      ///< In this process.
    const CircuitBreaker* breaker;

    /// An instance that overran its time is never entered again before it has come back.
    bool hangs() const;
  };

  /// The CSPs of an interface, for as long as the Broker's table stays as it is.
  struct Roster {
    std::uint64_t generation = UINT64_MAX;
    std::vector<Known> csps;
  };

  /// A CSP in this process that did not answer in time; perhaps it has since.
  struct Hung {
    std::string_view interface;
    std::string csp;
    bool tell;  ///< Whether it is told of when it is looked at next.
  };

  struct Running {
    std::uint64_t run;
    std::string csp;
    std::uint32_t pid;
    std::shared_ptr<const std::string> host;  // null where it has just left
  };

  const Parts parts;
  const HeadOptions options;
  entity::KeptDecisions decisions;
  entity::SessionStrategies strategies;
  entity::CspChannels channels;
  entity::HeadWarnings warnings;
  mutable std::mutex mutex;
  std::map<std::pair<std::string, std::string>, CircuitBreaker, ByCsp> breakers;
  std::unordered_map<const InterfaceInfo*, Roster> rosters;
  std::vector<Running> running;
  std::map<Guid, Hung> hung;
  std::vector<const Watch*> watches;
  TimerId watch_timer = 0;  // armed while there are watches, and until the next round after them
  RecentSet<Guid> told_unusable{64};
  bool was_degraded = false;
  std::uint64_t last_run = 0;
  entity::HeadLearning learning;  // ends first, and writes the history

 private:
  const Roster& roster(const InterfaceInfo& interface);
  /// `usable`: how many CSPs `query`, which names the Head's version of the interface, has found.
  void tell_unusable(brokerless_discovery::Query query, std::size_t usable);
  Known known(const InterfaceInfo& interface,
              const std::shared_ptr<const brokerless_discovery::ServiceDescription>& described);
  std::shared_ptr<const std::string> host_of(const InterfaceInfo& interface,
                                             const Guid& provider) const;
  CircuitBreaker& breaker(std::string_view interface, std::string_view csp);
  std::size_t stuck();
  void arm_watch_timer(Instant next_end);
  void look_at_watches();
};

template <class Decide>
void Head::State::record(introspection::Decision& record, Instant begin,
                         introspection::Decision* wanted, Decide decide) {
  std::exception_ptr failure;
  try {
    decide();
  } catch (...) {
    failure = std::current_exception();
    record.failure = task_run::verdict_of_current_exception().text;
  }
  record.took = wire_values::ns(parts.clock.now() - begin);
  conclude(std::move(record), wanted);
  if (failure) std::rethrow_exception(failure);
}

}  // namespace skein
