#include <algorithm>

#include "schedule.hpp"
#include "selection_text.hpp"
#include "skein/selection.hpp"

namespace skein {
namespace {

using entity::Cases;
using entity::Losses;
using entity::Outlook;
using entity::Schedule;
using entity::Scheduler;
using selection_text::in_ms;
using selection_text::joined;
using selection_text::number;

double seconds(Duration duration) { return std::chrono::duration<double>(duration).count(); }

Duration duration(double seconds) {
  const std::chrono::duration<double> time(seconds);
  return time < Duration::max() ? std::chrono::round<Duration>(time) : Duration::max();
}

std::size_t runs_of(const Candidate& candidate) {
  return candidate.learned ? candidate.learned->runs.size() : 0;
}

class Choice {
 public:
  Choice(const std::vector<Candidate>& candidates, const Situation& situation)
      : candidates_(candidates),
        situation_(situation),
        losses_(situation, candidates),
        cases_(count_runs()) {
    outlooks_.reserve(candidates.size());
    for (const Candidate& candidate : candidates)
      outlooks_.emplace_back(candidate, losses_, cases_);
    std::vector<Outlook> tried;
    for (const Tried& each : situation.tried) tried.emplace_back(each.candidate, losses_, cases_);
    weights_ = cases_.weights();
    for (std::size_t i = 0; i < tried.size(); ++i) {
      const double took = seconds(situation.tried[i].took);
      const auto chance = tried[i].within(took, losses_, weights_);
      weights_ = tried[i].after_failing(took, chance.answers, weights_);
    }
    normalise();
  }

  Selection select() const {
    const Schedule schedule = Scheduler(outlooks_, losses_, remaining()).best(weights_);
    if (const auto other = to_explore(schedule)) return explore(*other, schedule);
    return take(schedule);
  }

 private:
  double remaining() const { return seconds(situation_.remaining); }

  std::size_t count_runs() const {
    std::size_t count = 0;
    for (const Candidate& candidate : candidates_) count += runs_of(candidate);
    for (const Tried& each : situation_.tried) count += runs_of(each.candidate);
    return count;
  }

  // What cannot be told apart from any other request counts 1.
  void normalise() {
    const float most = weights_.empty() ? 1 : *std::max_element(weights_.begin(), weights_.end());
    if (most <= 0) return;
    for (float& weight : weights_) weight /= most;
  }

  // Half of the time, or less where the best one needs more than that.
  double exploration_slice(const Schedule& schedule) const {
    constexpr double kMargin = 1.25;
    const double needed = kMargin * outlooks_[schedule.first.candidate].longest();
    return std::min(remaining() / 2, remaining() - needed);
  }

  // The one that has not run for longest, where there is time for the best as well.
  std::optional<std::size_t> to_explore(const Schedule& schedule) const {
    constexpr double kLeastShare = 0.125;
    const auto& past = situation_.past;
    if (static_cast<double>(past.explored + 1) >
            situation_.exploration * static_cast<double>(past.made + 1) ||
        exploration_slice(schedule) < kLeastShare * remaining())
      return std::nullopt;
    std::optional<std::size_t> other;
    for (std::size_t i = 0; i < candidates_.size(); ++i) {
      if (i == schedule.first.candidate || 2 * outlooks_[i].typical() > remaining()) continue;
      if (!other || idle(i) > idle(*other)) other = i;
    }
    return other;
  }

  std::uint64_t idle(std::size_t index) const {
    const auto& learned = candidates_[index].learned;
    return learned ? learned->idle : UINT64_MAX;
  }

  Selection explore(std::size_t other, const Schedule& schedule) const {
    const Candidate& candidate = candidates_[other];
    const std::string why =
        candidate.learned
            ? " (it has not run for " + std::to_string(candidate.learned->idle) + " decisions)"
            : " (it has not run before)";
    const Duration slice = duration(exploration_slice(schedule));
    return {
        other, slice,
        joined({candidate.name, " is tried to learn of it", why, "; ",
                in_ms(situation_.remaining - slice), " are kept for ",
                candidates_[schedule.first.candidate].name, ", which is the best by its history"}),
        duration(outlooks_[other].longest()), true};
  }

  Selection take(const Schedule& schedule) const {
    const auto [index, slice] = schedule.first;
    const Duration given = std::min(duration(slice), situation_.remaining);
    std::string reason = joined({candidates_[index].name, schedule.second ? " first for " : " for ",
                                 in_ms(given), ": ", shown_within(index, slice)});
    if (schedule.second) reason += follower_text(schedule);
    return {index, given, std::move(reason), duration(outlooks_[index].longest())};
  }

  // "9 of 12 similar requests were answered by then".
  std::string shown_within(std::size_t index, double slice) const {
    const Candidate& candidate = candidates_[index];
    if (!outlooks_[index].has_run()) {
      return joined({"it declares ",
                     candidate.latency ? in_ms(*candidate.latency) : std::string("no latency"),
                     " and quality ", number(candidate.quality), ", and has not run before"});
    }
    const auto [answered, known] = outlooks_[index].count(slice, weights_);
    if (known == 0) return "nothing like this request has been seen";
    std::string text =
        joined({std::to_string(answered), " of ", std::to_string(known),
                known == 1 ? " similar request" : " similar requests",
                situation_.tried.empty() ? "" : " that are left", " answered by then"});
    if (candidate.learned->quality)
      text += joined({", quality ", number(*candidate.learned->quality)});
    return text;
  }

  // "; AStar after that, because it answered 3 of the other 3".
  std::string follower_text(const Schedule& schedule) const {
    const Outlook& first = outlooks_[schedule.first.candidate];
    const Outlook& second = outlooks_[*schedule.second];
    const double slice = schedule.first.slice;
    const auto chance = first.within(slice, losses_, weights_);
    const auto after = first.after_failing(slice, chance.answers, weights_);
    const auto [answered, known] = second.count(remaining() - slice, after);
    std::string text = joined({"; ", candidates_[*schedule.second].name, " after that"});
    if (!second.has_run()) return text + ", which has not run before";
    if (known == 0) return text;
    if (answered == 0)
      return text + joined({", though it answered none of the other ", std::to_string(known)});
    return text + joined({", because it answered ", std::to_string(answered), " of the other ",
                          std::to_string(known)});
  }

  const std::vector<Candidate>& candidates_;
  const Situation& situation_;
  const Losses losses_;
  Cases cases_;
  std::vector<Outlook> outlooks_;
  Cases::Weights weights_;
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
