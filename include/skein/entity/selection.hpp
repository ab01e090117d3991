#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "skein/core/clock.hpp"
#include "skein/core/guid.hpp"
#include "skein/entity/circuit_breaker.hpp"
#include "skein/entity/history.hpp"

// The paper's Algorithm Selection pattern (Figure 7), part by part: a StrategyFactory makes the
// SelectionStrategy that a session names; a CandidateIterator walks the CSPs in the order that it
// decides; each is an Adapter, an algorithm behind a managed interface, and is reached by that
// interface's Proxy.
namespace skein {

/// A CSP that could run the task, with what its description promises and what is known of it.
struct Candidate {
  std::string name;  ///< The CSP's, `AStar`.
  Guid provider;
  bool in_process = false;
  std::uint32_t pid = 0;
  /// Attribute `latency`: the time that an answer is declared to take. Nothing: not declared.
  std::optional<Duration> latency;
  /// Attribute `quality`: greater is better. Not declared counts as 0.
  double quality = 0;
  /// What its history says; nothing for one that has never run.
  std::optional<Prediction> learned;
  CircuitBreaker::State breaker = CircuitBreaker::State::Closed;
  Duration quarantine{};  ///< Until it may be probed.
  /// 0 for those that stood by when the request came, 1 for those that had joined when all of these
  /// had failed, and so on.
  std::uint32_t round = 0;
};

/// What a strategy may know of a request beside the candidates.
struct Situation {
  Features features{};
  Duration remaining{};
  /// The share of decisions that may try a CSP only to learn of it, and what was done so far.
  double exploration = 0;
  History::Decisions past{};
};

/// What a strategy decided: which candidate runs next, for how long at most, and why, in words.
struct Selection {
  std::size_t candidate = 0;  ///< Index into the candidates.
  Duration slice{};
  std::string reason;
  Duration expected{};    ///< When an answer is expected; after that it is late. Zero: not known.
  bool explores = false;  ///< Chosen to learn of it.
};

/// Decides which CSP runs next. Asked again after each failure, with those that are left and the
/// time that is left. Pure: equal arguments give equal selections. Thread-safe.
class SelectionStrategy {
 public:
  virtual ~SelectionStrategy() = default;
  virtual std::string name() const = 0;
  /// `candidates` is not empty.
  virtual Selection select(const std::vector<Candidate>& candidates,
                           const Situation& situation) const = 0;
};

/// The best declared quality whose declared latency fits into the time left; the fastest where none
/// fits. Where that still leaves enough, the fastest other candidate's latency is kept in reserve,
/// and half of the time where the other half is four times the declared latency. Name: `declared`.
std::shared_ptr<const SelectionStrategy> make_declared_selection();

/// In the Broker's order, whatever is declared; the time left is shared evenly. Name:
/// `fixed_order`.
std::shared_ptr<const SelectionStrategy> make_fixed_order_selection();

/// By what each CSP's history predicts for such a request (what it declares, until it has run): the
/// greatest utility, reliability times quality, among those whose 95 % latency fits into the time
/// left; of those within 5 % of it the quickest. A reserve is kept as by `declared`. Another may
/// have a try of no more than its 95 % latency before it: one whose quality is no less, where the
/// time suffices for both and it is expected to take less time per accepted result (Smith's rule).
/// Within the budget for exploration the CSP that has not run for longest goes first, where the
/// time suffices for the best one after it. Name: `learned`.
std::shared_ptr<const SelectionStrategy> make_learned_selection();

/// The strategies that there are, by name; the three above from the start.
class StrategyFactory {
 public:
  StrategyFactory();
  void add(std::shared_ptr<const SelectionStrategy> strategy);
  /// Throws InvalidArgument for an unknown name, with the known ones.
  std::shared_ptr<const SelectionStrategy> make(const std::string& name) const;

 private:
  std::map<std::string, std::shared_ptr<const SelectionStrategy>> strategies_;
};

/// What a strategy answered when it was asked, as it stands in the record of a decision.
struct Choice {
  std::string csp;
  Duration remaining{};  ///< The time left when it was asked.
  Duration slice{};
  Duration expected{};  ///< When an answer was expected; zero: not known.
  bool explores = false;
  std::string reason;  ///< Why it was chosen.
  bool operator==(const Choice&) const = default;
};

/// The CSPs for one request, one after the other as the strategy selects them. Those in quarantine
/// are passed over; where all are, the one whose quarantine ends first is tried: better than no try
/// at all.
class CandidateIterator {
 public:
  /// The strategy outlives the iterator.
  CandidateIterator(const SelectionStrategy& strategy, std::vector<Candidate> candidates,
                    Situation situation);

  /// Goes on with others, once it is done.
  void add(std::vector<Candidate> candidates);

  bool done() const noexcept { return left_.empty(); }

  struct Next {
    Candidate candidate;
    Choice choice;
  };
  /// Not once it is done.
  Next next(Duration remaining);

 private:
  const SelectionStrategy& strategy_;
  std::vector<Candidate> left_;
  Situation situation_;
};

}  // namespace skein
