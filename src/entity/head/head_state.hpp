#pragma once

#include <exception>

#include "csp_channels.hpp"
#include "head_learning.hpp"
#include "kept_decisions.hpp"
#include "known_csps.hpp"
#include "lost_csps.hpp"
#include "overdue_csps.hpp"
#include "running_csps.hpp"
#include "selection/wire_values.hpp"
#include "session_strategies.hpp"

namespace skein {

/// The state that a Head keeps across requests: each part has its own lock. Thread-safe.
struct Head::State {
  State(const Parts& parts, HeadOptions options);

  /// Those that are available; perhaps none.
  std::vector<Candidate> candidates(const InterfaceInfo& interface, const TaskOptions& task,
                                    const SelectionStrategy& strategy, Instant now);
  /// The same; if there is none, waits for a CSP that died to come back, until `deadline`.
  std::vector<Candidate> await_candidates(const InterfaceInfo& interface, const TaskOptions& task,
                                          const SelectionStrategy& strategy, Instant deadline);
  /// Waits for the Broker's next change after `seen` while a CSP that died may come back, until
  /// `deadline`. Returns false if there was none.
  bool await_change(const InterfaceInfo& interface, const entity::LostCsps& lost,
                    std::uint64_t seen, Instant deadline) const;

  /// Tells all parts how a run ended, and HeadOptions::on_hang if the CSP hangs.
  void end(const InterfaceInfo& interface, const Candidate& candidate,
           const std::shared_ptr<const Features>& features, std::uint64_t run,
           const entity::RunEnding& ending);
  /// Runs `decide()`, which fills the record, and keeps that, also if it throws. `wanted` gets a
  /// copy unless it is null.
  template <class Decide>
  void record(introspection::Decision& record, Instant begin, introspection::Decision* wanted,
              Decide decide);
  void conclude(introspection::Decision&& record, introspection::Decision* wanted);

  const Parts parts;
  const HeadOptions options;
  entity::KeptDecisions decisions;
  entity::SessionStrategies strategies;
  entity::HeadWarnings warnings;
  entity::KnownCsps known;
  entity::CspChannels channels;
  entity::RunningCsps running;
  entity::OverdueCsps overdue;
  entity::HeadLearning learning;  // last: if another part cannot be made, no history is written
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
