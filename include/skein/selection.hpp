#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "skein/clock.hpp"
#include "skein/detail/circuit_breaker.hpp"
#include "skein/guid.hpp"

namespace skein::introspection {
enum class Outcome : std::uint32_t;
struct Attempt;
struct Decision;
}  // namespace skein::introspection

// The paper's Algorithm Selection pattern (Figure 7): a StrategyFactory makes the SelectionStrategy
// that a session names; a CandidateIterator returns the CSPs in the order that the strategy
// decides; each CSP is an Adapter, an algorithm behind a managed interface, and is called through
// that interface's Proxy.
namespace skein {

/// A property of a request that may matter for the choice, as a number: `{"cells", 65536}`.
struct Feature {
  std::string name;
  double value = 0;
  bool operator==(const Feature&) const = default;
};
using Features = std::vector<Feature>;

/// Runs of at least this weight were on similar requests. Others are listed for lack of better
/// ones.
inline constexpr double kSimilar = 0.1;

/// A past run.
struct SimilarRun {
  std::uint64_t request = 0;  ///< The request's number: equal for CSPs that ran on the same one.
  /// 0 to 1: how similar the requests are. Less if the CSP ran only because others had failed, as
  /// few requests get that far. 0 if it is listed only because another CSP ran on that request.
  double weight = 0;
  Duration took{};
  bool accepted = false;
  bool late = false;  ///< Given up: an answer would have taken longer than `took`.
  std::optional<double> quality;
  bool operator==(const SimilarRun&) const = default;
};

/// What a CSP's own history predicts for a request.
struct Prediction {
  std::vector<SimilarRun> runs;  ///< The most similar first; 1 to 16 with a weight.
  std::size_t similar = 0;       ///< How many of these have a weight of at least kSimilar.
  /// Time to an accepted result, by weight; unset if none of these runs was accepted or late. A
  /// late run counts with twice its time.
  std::optional<Duration> median;
  std::optional<Duration> p95;
  std::optional<double> quality;  ///< Mean of the measured values, by weight.
  double reliability = 1;         ///< Share of accepted results, with one success added.
  std::uint64_t idle = 0;         ///< Requests since it last ran.
  bool operator==(const Prediction&) const = default;
};

/// How many decisions were made before.
struct PastDecisions {
  std::uint64_t made = 0;
  std::uint64_t explored = 0;  ///< Of these, those that tried a CSP only to learn about it.

  bool operator==(const PastDecisions&) const = default;
};

/// A CSP that could run the task, with what it declares and what is known about it.
struct Candidate {
  std::string name;  ///< The CSP's name: `AStar`.
  Guid provider;
  bool in_process = false;
  std::uint32_t pid = 0;
  /// Attribute `latency`: the declared time to an answer, a plain number in ms or a duration as
  /// Constraint knows it. Unset: not declared.
  std::optional<Duration> latency;
  /// Attribute `quality`: greater is better; 0 if not declared.
  double quality = 0;
  /// What its history predicts; unset if it has never run.
  std::optional<Prediction> learned;
  CircuitBreaker::State breaker = CircuitBreaker::State::Closed;
  Duration quarantine{};  ///< Time until it may be probed.
  /// 0 for CSPs that were available when the request came, 1 for those that joined when all of
  /// these had failed, and so on.
  std::uint32_t round = 0;
};

/// What a task is worth, by its result.
struct Utility {
  enum class Aim {
    BestByDeadline,  ///< First an answer by the deadline, then its quality, then its time.
    AnyByDeadline,   ///< An answer by the deadline, whatever its quality; then its time.
    GoodEnoughSoon,  ///< A quality of `good_enough`, soon; what is less counts half.
  };
  Aim aim = Aim::BestByDeadline;
  double good_enough = 0;  ///< On the scale of the attribute `quality`; with GoodEnoughSoon.
  bool operator==(const Utility&) const = default;
};

const char* to_string(Utility::Aim aim) noexcept;

/// A candidate that has been tried for this request, without success.
struct Tried {
  Candidate candidate;
  Duration took{};  ///< It has not answered within this time.
};

/// What a strategy knows about a request, beside the candidates.
struct Situation {
  Features features{};
  Duration remaining{};
  /// The share of decisions that may try a CSP only to learn about it, and the decisions so far.
  double exploration = 0;
  PastDecisions past{};
  Utility utility{};
  std::vector<Tried> tried{};  ///< In this order. Filled by CandidateIterator.
};

/// A strategy's decision: which candidate runs next, for how long at most (with Execution::One),
/// and why, in words.
struct Selection {
  std::size_t candidate = 0;  ///< Index into the candidates.
  Duration slice{};
  std::string reason;
  Duration expected{};    ///< Expected time to an answer; later is late. Zero: unknown.
  bool explores = false;  ///< Chosen only to learn about it.
};

/// Decides which CSP runs next. It is asked for each CSP, with the candidates and the time that are
/// left. Pure: equal arguments give equal selections. Thread-safe.
class SelectionStrategy {
 public:
  virtual ~SelectionStrategy() = default;
  virtual std::string name() const = 0;
  /// Whether Candidate::learned is to be filled, which takes some 10 µs.
  virtual bool reads_history() const { return true; }
  /// `candidates` is not empty. A slice that is not longer than 0 ends the request, as does what
  /// this throws; no CSP is charged for it.
  virtual Selection select(const std::vector<Candidate>& candidates,
                           const Situation& situation) const = 0;
};

/// Selects the best declared quality among the CSPs whose declared latency fits into the time left;
/// if none fits, the fastest. An undeclared latency counts as 0. If the time suffices, the latency
/// of the fastest other CSP is reserved for a fall-back, or an even share of the time if no other
/// declares one; the slice is then at most half of the time, or four times the declared latency if
/// that is longer. Name: `declared`.
std::shared_ptr<const SelectionStrategy> make_declared_selection();

/// Uses the Broker's order, whatever is declared, and shares the time left evenly. Name:
/// `fixed_order`.
std::shared_ptr<const SelectionStrategy> make_fixed_order_selection();

/// Makes a schedule, a sequence of CSPs with a time slice each, and returns its first step: the one
/// with the greatest expected utility (Situation::utility) by what CSPs made of similar requests;
/// asked again after a failure, it takes into account who has failed for how long. The chance that
/// a CSP answers within a slice is the share of similar requests for which it did; a run that was
/// stopped earlier counts by those that went on; a CSP that has not run counts as it declares. The
/// slices of up to three CSPs are even unless others are clearly better; of more, the first one
/// gets all of the time, or as much as costs it no chance, unless a shorter slice is clearly
/// better. Within the budget for exploration, the CSP that has not run for longest goes first,
/// where enough is left for the best one. Name: `learned`.
std::shared_ptr<const SelectionStrategy> make_learned_selection();

/// The selection strategies by name; those above from the start.
class StrategyFactory {
 public:
  StrategyFactory();
  /// Replaces a strategy of the same name.
  void add(std::shared_ptr<const SelectionStrategy> strategy);
  /// Throws InvalidArgument for an unknown name; the text lists the known ones.
  std::shared_ptr<const SelectionStrategy> make(const std::string& name) const;
  /// Sorted.
  std::vector<std::string> names() const;

 private:
  std::map<std::string, std::shared_ptr<const SelectionStrategy>> strategies_;
};

/// The CSPs for one request, in the order that the strategy selects. CSPs in quarantine are
/// skipped; if all are, the one whose quarantine ends first is tried.
class CandidateIterator {
 public:
  /// The strategy must outlive the iterator.
  CandidateIterator(const SelectionStrategy& strategy, std::vector<Candidate> candidates,
                    Situation situation);

  /// Continues with other candidates; only if done().
  void add(std::vector<Candidate> candidates);

  bool done() const noexcept { return left_.empty(); }

  struct Next {
    Candidate candidate;
    Selection selection;  ///< Its slice is at most the time left.
  };
  /// `remaining` is the time left. Only if not done(). Throws Internal if the strategy selects a
  /// candidate that does not exist, gives it no time, or throws, which is named; an Error of the
  /// strategy's keeps its class.
  Next next(Duration remaining);

 private:
  Selection select() const;

  const SelectionStrategy& strategy_;
  std::vector<Candidate> left_;
  Situation situation_;
};

/// In plain words: `accepted`, `timed out`. "skein/introspection.idl.hpp" defines this type and
/// those of the functions that follow.
const char* in_words(introspection::Outcome outcome) noexcept;

/// Whether both chose the same for the same reasons and for as long, whatever came of it.
bool same_choice(const introspection::Attempt& one, const introspection::Attempt& other);

/// Makes a record's choices again, from what the record says was known. Returns the attempts with
/// these choices; they equal the record's attempts bit for bit, unless the strategy has changed.
/// Throws InvalidArgument for an unknown strategy and for an inconsistent record.
std::vector<introspection::Attempt> replay(const introspection::Decision& record,
                                           const StrategyFactory& strategies = {});

/// The decision in plain words, in several lines.
std::string explain(const introspection::Decision& record);

}  // namespace skein
