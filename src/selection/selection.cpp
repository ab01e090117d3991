#include "skein/selection.hpp"

#include <algorithm>

#include "core/suggestion.hpp"
#include "selection_text.hpp"
#include "skein/detail/task_run.hpp"
#include "skein/error.hpp"
#include "slice.hpp"

namespace skein {
namespace {

using selection_text::in_ms;
using selection_text::joined;
using selection_text::number;

// A latency that is not declared is taken for none: such a candidate is never ruled out by time.
Duration latency_of(const Candidate& candidate) {
  return candidate.latency.value_or(Duration::zero());
}

class DeclaredSelection final : public SelectionStrategy {
 public:
  std::string name() const override { return "declared"; }
  bool reads_history() const override { return false; }

  Selection select(const std::vector<Candidate>& candidates,
                   const Situation& situation) const override {
    const Duration remaining = situation.remaining;
    const Candidate* best = nullptr;
    for (const Candidate& candidate : candidates) {
      if (latency_of(candidate) > remaining) continue;
      if (!best || better(candidate, *best)) best = &candidate;
    }
    if (!best) return fastest_anyway(candidates, remaining);
    const Duration slice =
        slice_beside(latency_of(*best), reserve(*best, candidates, remaining), remaining);
    const Duration kept = remaining - slice;
    const bool keeps = kept > Duration::zero();
    std::string reason =
        joined({best->name, " has the best declared quality (", number(best->quality),
                ") of those whose latency fits into ", in_ms(remaining),
                " (its own: ", in_ms(latency_of(*best)), keeps ? "); " : ")",
                keeps ? in_ms(kept) : "", keeps ? " are kept for a fall-back" : ""});
    return {index_of(*best, candidates), slice, std::move(reason), latency_of(*best)};
  }

 private:
  static bool better(const Candidate& a, const Candidate& b) {
    if (a.quality != b.quality) return a.quality > b.quality;
    return latency_of(a) < latency_of(b);
  }

  static std::size_t index_of(const Candidate& candidate,
                              const std::vector<Candidate>& candidates) {
    return static_cast<std::size_t>(&candidate - candidates.data());
  }

  static Duration reserve(const Candidate& best, const std::vector<Candidate>& candidates,
                          Duration remaining) {
    std::optional<Duration> least;
    for (const Candidate& candidate : candidates) {
      if (&candidate == &best || !candidate.latency) continue;
      least = std::min(least.value_or(Duration::max()), *candidate.latency);
    }
    return reserve_beside(latency_of(best), least, candidates.size() - 1, remaining);
  }

  static Selection fastest_anyway(const std::vector<Candidate>& candidates, Duration remaining) {
    const auto fastest = std::min_element(
        candidates.begin(), candidates.end(),
        [](const Candidate& a, const Candidate& b) { return latency_of(a) < latency_of(b); });
    return {index_of(*fastest, candidates), remaining,
            "no declared latency fits into " + in_ms(remaining) + "; " + fastest->name +
                " is the fastest (" + in_ms(latency_of(*fastest)) + ")",
            latency_of(*fastest)};
  }
};

class FixedOrderSelection final : public SelectionStrategy {
 public:
  std::string name() const override { return "fixed_order"; }
  bool reads_history() const override { return false; }

  Selection select(const std::vector<Candidate>& candidates,
                   const Situation& situation) const override {
    const Duration share = situation.remaining / static_cast<Duration::rep>(candidates.size());
    return {0, share > Duration::zero() ? share : situation.remaining,
            candidates.front().name + " is the next in order; " +
                std::to_string(candidates.size() - 1) + " others share the time that is left",
            latency_of(candidates.front())};
  }
};

}  // namespace

std::shared_ptr<const SelectionStrategy> make_declared_selection() {
  return std::make_shared<DeclaredSelection>();
}

std::shared_ptr<const SelectionStrategy> make_fixed_order_selection() {
  return std::make_shared<FixedOrderSelection>();
}

StrategyFactory::StrategyFactory() {
  add(make_fixed_order_selection());
  add(make_declared_selection());
  add(make_learned_selection());
}

void StrategyFactory::add(std::shared_ptr<const SelectionStrategy> strategy) {
  if (!strategy) throw InvalidArgument("a selection strategy to be added is null");
  const std::string name = strategy->name();
  strategies_[name] = std::move(strategy);
}

std::shared_ptr<const SelectionStrategy> StrategyFactory::make(const std::string& name) const {
  if (const auto found = strategies_.find(name); found != strategies_.end()) return found->second;
  const std::vector<std::string> known = names();
  std::string list;
  for (const std::string& each : known) list += (list.empty() ? "" : ", ") + each;
  throw InvalidArgument("unknown selection strategy '" + name + "'" + suggestion(name, known) +
                        "; there are: " + list);
}

std::vector<std::string> StrategyFactory::names() const {
  std::vector<std::string> names;
  for (const auto& [name, strategy] : strategies_) names.push_back(name);
  return names;
}

CandidateIterator::CandidateIterator(const SelectionStrategy& strategy,
                                     std::vector<Candidate> candidates, Situation situation)
    : strategy_(strategy), situation_(std::move(situation)) {
  add(std::move(candidates));
}

const char* to_string(Utility::Aim aim) noexcept {
  switch (aim) {
    case Utility::Aim::AnyByDeadline:
      return "any_by_deadline";
    case Utility::Aim::GoodEnoughSoon:
      return "good_enough_soon";
    case Utility::Aim::BestByDeadline:
      break;
  }
  return "best_by_deadline";
}

void CandidateIterator::add(std::vector<Candidate> candidates) {
  left_ = std::move(candidates);
  const auto closed = [](const Candidate& candidate) {
    return candidate.breaker == CircuitBreaker::State::Open;
  };
  const auto first_out = std::min_element(
      left_.begin(), left_.end(),
      [](const Candidate& a, const Candidate& b) { return a.quarantine < b.quarantine; });
  if (std::all_of(left_.begin(), left_.end(), closed) && !left_.empty()) {
    left_ = {Candidate(*first_out)};
  } else {
    std::erase_if(left_, closed);
  }
}

Selection CandidateIterator::select() const {
  try {
    return strategy_.select(left_, situation_);
  } catch (...) {
    task_run::throw_as_thrown_by("the strategy '" + strategy_.name() + "'",
                                 std::current_exception());
  }
}

CandidateIterator::Next CandidateIterator::next(Duration remaining) {
  if (!situation_.tried.empty()) situation_.tried.back().took = situation_.remaining - remaining;
  situation_.remaining = remaining;
  Selection selection = select();
  situation_.exploration = 0;  // only a request's first choice explores
  if (selection.candidate >= left_.size()) {
    throw Internal("the strategy '" + strategy_.name() + "' selected candidate " +
                   std::to_string(selection.candidate) + " of " + std::to_string(left_.size()));
  }
  if (selection.slice <= Duration::zero() && remaining > Duration::zero()) {
    throw Internal("the strategy '" + strategy_.name() + "' gave CSP '" +
                   left_[selection.candidate].name + "' a time slice of " + in_ms(selection.slice) +
                   ", while " + in_ms(remaining) +
                   " are left; a slice (Selection::slice) is longer than 0");
  }
  selection.slice =
      std::clamp(selection.slice, Duration::zero(), std::max(remaining, Duration::zero()));
  const auto chosen = left_.begin() + static_cast<std::ptrdiff_t>(selection.candidate);
  situation_.tried.push_back({*chosen});
  Next next{std::move(*chosen), std::move(selection)};
  left_.erase(chosen);
  return next;
}

}  // namespace skein
