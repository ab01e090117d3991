#include <algorithm>

#include "selection_text.hpp"
#include "skein/selection.hpp"
#include "slice.hpp"

namespace skein {
namespace {

using selection_text::in_ms;
using selection_text::joined;
using selection_text::number;
using selection_text::percent;

// Utilities this near to each other are taken for equal: they rest on few samples.
constexpr double kEqual = 0.95;
// So that reliability counts where neither declares nor measures a quality.
constexpr double kLeastQuality = 1e-9;

// What is expected of a candidate: of its history, or of its description where it has none.
struct Outlook {
  explicit Outlook(const Candidate& candidate) {
    timed = candidate.latency.has_value();
    typical = safe = candidate.latency.value_or(Duration::zero());
    quality = candidate.quality;
    if (const auto& learned = candidate.learned) {
      typical = learned->median.value_or(typical);
      safe = learned->p95.value_or(safe);
      timed |= learned->p95.has_value();
      quality = learned->quality.value_or(quality);
      reliability = learned->reliability;
    }
    quality = std::max(quality, kLeastQuality);
  }

  double utility() const { return reliability * quality; }
  // Expected time until a result is accepted: of several that follow each other the sum is least
  // where those with the least pace go first. A failure is taken to cost the p95 latency.
  double pace() const {
    return static_cast<double>(typical.count()) +
           (1 - reliability) / reliability * static_cast<double>(safe.count());
  }

  bool timed;  // declared or measured
  Duration typical;
  Duration safe;
  double quality;
  double reliability = 1;
};

class Choice {
 public:
  Choice(const std::vector<Candidate>& candidates, const Situation& situation)
      : candidates_(candidates),
        situation_(situation),
        outlooks_(candidates.begin(), candidates.end()) {}

  Selection select() const {
    const auto best = best_that_fits();
    if (!best) return fastest_anyway();
    if (const auto other = to_explore(*best)) return explore(*other, *best);
    if (const auto quick = worth_a_try(*best)) return try_first(*quick, *best);
    return take(*best);
  }

 private:
  std::optional<std::size_t> best_that_fits() const {
    double greatest = 0;
    for (const Outlook& outlook : outlooks_) {
      if (outlook.safe <= situation_.remaining) greatest = std::max(greatest, outlook.utility());
    }
    std::optional<std::size_t> best;
    for (std::size_t i = 0; i < outlooks_.size(); ++i) {
      if (outlooks_[i].safe > situation_.remaining || outlooks_[i].utility() < kEqual * greatest)
        continue;
      if (!best || outlooks_[i].typical < outlooks_[*best].typical) best = i;
    }
    return best;
  }

  // One that is as good where it succeeds, and so quick that it costs less to try it first than it
  // saves; where there is time for it and then for the best.
  std::optional<std::size_t> worth_a_try(std::size_t best) const {
    std::optional<std::size_t> quick;
    for (std::size_t i = 0; i < outlooks_.size(); ++i) {
      if (i == best || outlooks_[i].safe + outlooks_[best].safe > situation_.remaining ||
          outlooks_[i].quality < kEqual * outlooks_[best].quality)
        continue;
      if (outlooks_[i].pace() < outlooks_[quick.value_or(best)].pace()) quick = i;
    }
    return quick;
  }

  Selection try_first(std::size_t quick, std::size_t best) const {
    return {quick, outlooks_[quick].safe,
            candidates_[quick].name + " has " + outlook_text(quick) + ": worth a try before " +
                candidates_[best].name + ", for which " + in_ms(outlooks_[best].safe) + " are kept",
            outlooks_[quick].safe};
  }

  // The one that has not run for longest, where there is time for it and then for the best.
  std::optional<std::size_t> to_explore(std::size_t best) const {
    const auto& past = situation_.past;
    if (static_cast<double>(past.explored + 1) >
        situation_.exploration * static_cast<double>(past.made + 1)) {
      return std::nullopt;
    }
    std::optional<std::size_t> other;
    for (std::size_t i = 0; i < candidates_.size(); ++i) {
      if (i == best || outlooks_[i].safe + outlooks_[best].safe > situation_.remaining) continue;
      if (!other || idle(i) > idle(*other)) other = i;
    }
    return other;
  }

  std::uint64_t idle(std::size_t index) const {
    const auto& learned = candidates_[index].learned;
    return learned ? learned->idle : UINT64_MAX;
  }

  Selection explore(std::size_t other, std::size_t best) const {
    std::string reason = candidates_[other].name + " is tried to learn of it";
    reason += candidates_[other].learned
                  ? " (it has not run for " + std::to_string(candidates_[other].learned->idle) +
                        " decisions)"
                  : " (it has not run before)";
    reason += "; " + in_ms(outlooks_[best].safe) + " are kept for " + candidates_[best].name +
              ", which is the best by its history";
    return {other, situation_.remaining - outlooks_[best].safe, std::move(reason),
            outlooks_[other].safe, true};
  }

  Selection take(std::size_t best) const {
    const Duration slice = slice_beside(outlooks_[best].safe, reserve(best), situation_.remaining);
    const Duration kept = situation_.remaining - slice;
    const bool keeps = kept > Duration::zero();
    std::string reason =
        joined({candidates_[best].name, ": ", outlook_text(best), ": the best that fits into ",
                in_ms(situation_.remaining), keeps ? "; " : "", keeps ? in_ms(kept) : "",
                keeps ? " are kept for a fall-back" : ""});
    return {best, slice, std::move(reason), outlooks_[best].safe};
  }

  std::string outlook_text(std::size_t index) const {
    const Candidate& candidate = candidates_[index];
    const auto& learned = candidate.learned;
    const std::string p95 = "p95 " + in_ms(outlooks_[index].safe);
    if (!learned) {
      return joined({"declares ", p95, " and quality ", number(candidate.quality),
                     " (it has not run before)"});
    }
    return joined({p95, " over ", std::to_string(learned->samples),
                   learned->samples == 1 ? " similar request" : " similar requests", ", quality ",
                   number(learned->quality.value_or(candidate.quality)), ", reliability ",
                   percent(learned->reliability)});
  }

  Duration reserve(std::size_t best) const {
    std::optional<Duration> least;
    for (std::size_t i = 0; i < outlooks_.size(); ++i) {
      if (i != best && outlooks_[i].timed)
        least = std::min(least.value_or(Duration::max()), outlooks_[i].safe);
    }
    return reserve_beside(outlooks_[best].safe, least, outlooks_.size() - 1, situation_.remaining);
  }

  Selection fastest_anyway() const {
    std::size_t fastest = 0;
    for (std::size_t i = 1; i < outlooks_.size(); ++i) {
      if (outlooks_[i].safe < outlooks_[fastest].safe) fastest = i;
    }
    return {fastest, situation_.remaining,
            "no predicted latency fits into " + in_ms(situation_.remaining) + "; " +
                candidates_[fastest].name + " is the fastest (p95 " +
                in_ms(outlooks_[fastest].safe) + ")",
            outlooks_[fastest].safe};
  }

  const std::vector<Candidate>& candidates_;
  const Situation& situation_;
  const std::vector<Outlook> outlooks_;
};

class LearnedSelection final : public SelectionStrategy {
 public:
  std::string name() const override { return "learned"; }
  Selection select(const std::vector<Candidate>& candidates,
                   const Situation& situation) const override {
    return Choice(candidates, situation).select();
  }
};

}  // namespace

std::shared_ptr<const SelectionStrategy> make_learned_selection() {
  return std::make_shared<LearnedSelection>();
}

}  // namespace skein
