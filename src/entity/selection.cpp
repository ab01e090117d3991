#include "skein/entity/selection.hpp"

#include <algorithm>

namespace skein {
namespace {

std::string in_ms(Duration duration) {
  return std::to_string(std::chrono::duration_cast<std::chrono::milliseconds>(duration).count()) + " ms";
}

// A latency that is not declared is taken for none: such a candidate is never ruled out by time.
Duration latency_of(const Candidate& candidate) { return candidate.latency.value_or(Duration::zero()); }

class DeclaredSelection final : public SelectionStrategy {
 public:
  std::string name() const override { return "declared"; }

  Selection select(const std::vector<Candidate>& candidates, Duration remaining) const override {
    const Candidate* best = nullptr;
    for (const Candidate& candidate : candidates) {
      if (latency_of(candidate) > remaining) continue;
      if (!best || better(candidate, *best)) best = &candidate;
    }
    if (!best) return fastest_anyway(candidates, remaining);
    const Duration reserve = reserve_beside(*best, candidates, remaining);
    std::string reason = best->name + " has the best declared quality (" + number(best->quality) +
                         ") of those whose latency fits into " + in_ms(remaining) + " (its own: " +
                         in_ms(latency_of(*best)) + ")";
    if (reserve > Duration::zero()) reason += "; " + in_ms(reserve) + " are kept for a fall-back";
    return {index_of(*best, candidates), remaining - reserve, std::move(reason)};
  }

 private:
  static bool better(const Candidate& a, const Candidate& b) {
    if (a.quality != b.quality) return a.quality > b.quality;
    return latency_of(a) < latency_of(b);
  }

  static std::size_t index_of(const Candidate& candidate, const std::vector<Candidate>& candidates) {
    return static_cast<std::size_t>(&candidate - candidates.data());
  }

  static std::string number(double value) {
    std::string text = std::to_string(value);
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
    return text;
  }

  static Duration reserve_beside(const Candidate& best, const std::vector<Candidate>& candidates,
                                 Duration remaining) {
    std::optional<Duration> least;
    for (const Candidate& candidate : candidates) {
      if (&candidate == &best || !candidate.latency) continue;
      least = std::min(least.value_or(Duration::max()), *candidate.latency);
    }
    const Duration reserve = least.value_or(Duration::zero());
    return latency_of(best) + reserve <= remaining ? reserve : Duration::zero();
  }

  static Selection fastest_anyway(const std::vector<Candidate>& candidates, Duration remaining) {
    const auto fastest = std::min_element(
        candidates.begin(), candidates.end(),
        [](const Candidate& a, const Candidate& b) { return latency_of(a) < latency_of(b); });
    return {index_of(*fastest, candidates), remaining,
            "no declared latency fits into " + in_ms(remaining) + "; " + fastest->name +
                " is the fastest (" + in_ms(latency_of(*fastest)) + ")"};
  }
};

class FixedOrderSelection final : public SelectionStrategy {
 public:
  std::string name() const override { return "fixed_order"; }

  Selection select(const std::vector<Candidate>& candidates, Duration remaining) const override {
    return {0, remaining / static_cast<Duration::rep>(candidates.size()),
            candidates.front().name + " is the next in order; " + std::to_string(candidates.size() - 1) +
                " others share the time that is left"};
  }
};

}  // namespace

std::shared_ptr<const SelectionStrategy> make_declared_selection() {
  return std::make_shared<DeclaredSelection>();
}

std::shared_ptr<const SelectionStrategy> make_fixed_order_selection() {
  return std::make_shared<FixedOrderSelection>();
}

}  // namespace skein
