#include "schedule.hpp"

#include <algorithm>
#include <limits>

#include "slice.hpp"

namespace skein::entity {
namespace {

// A slice beyond what was ever seen: the next request may be somewhat harder, the machine busier.
constexpr double kStretch = 1.5;
constexpr double kLoad = 0.005;
// How many times less loss a schedule must promise than one that risks nothing new, or among few
// how many times more gain: what is best of many by few runs is seldom as good as it looks. Among
// few, an even share is what risks least; among many, all of the time, or a slice that costs the
// first one next to nothing.
constexpr double kClearlyOfFew = 1.55;
constexpr double kClearlyOfMany = 1.8;
constexpr double kNothing = 0.01;
// First steps are tried of so many candidates.
constexpr std::size_t kFirst = 3;

}  // namespace

Scheduler::Scheduler(std::span<const Outlook> outlooks, const Losses& losses, double remaining)
    : outlooks_(outlooks), losses_(losses), remaining_(remaining) {}

std::vector<double> Scheduler::slices(std::size_t candidate) const {
  const Outlook& outlook = outlooks_[candidate];
  std::vector<double> slices;
  const auto offer = [&](double slice) {
    const bool known = std::any_of(slices.begin(), slices.end(), [&](double other) {
      return slice > 0.9 * other && slice < 1.1 * other;
    });
    if (!known && slice <= remaining_) slices.push_back(slice);
  };
  offer(remaining_ / static_cast<double>(std::min(outlooks_.size(), kSharers)));
  offer(remaining_);
  offer(remaining_ / 2);
  if (outlook.longest() > 0) {  // something is known
    offer(kStretch * outlook.longest() + kLoad);
    offer(kStretch * outlook.typical() + kLoad);
  }
  return slices;
}

std::optional<Scheduler::Follower> Scheduler::best_follower(const Cases::Weights& weights,
                                                            std::size_t first, double left) const {
  std::optional<Follower> best;
  for (std::size_t i = 0; i < outlooks_.size(); ++i) {
    if (i == first) continue;
    const auto chance = outlooks_[i].within(left, losses_, weights);
    const double loss = chance.loss + (1 - chance.answers) * losses_.miss;
    if (!best || loss < best->loss) best = {i, loss, chance};
  }
  return best;
}

Schedule Scheduler::try_pair(const Step& step, const Cases::Weights& weights) const {
  const Outlook& outlook = outlooks_[step.candidate];
  const auto chance = outlook.within(step.slice, losses_, weights);
  const double fails = 1 - chance.answers;
  Schedule schedule{step, std::nullopt, chance.loss + fails * losses_.miss};
  if (step.slice >= remaining_) return schedule;
  const double rest = remaining_ - step.slice;
  const auto after = outlook.after_failing(step.slice, chance.answers, weights);
  const auto follower = best_follower(after, step.candidate, rest);
  if (!follower) return schedule;
  schedule.second = follower->candidate;
  // That both fail is as likely in the one order as in the other: so it must not decide on it.
  const Outlook& second = outlooks_[follower->candidate];
  const auto alone = second.within(rest, losses_, weights);
  const auto after_second = second.after_failing(rest, alone.answers, weights);
  const double reversed =
      (1 - alone.answers) * (1 - outlook.within(step.slice, losses_, after_second).answers);
  const double missed = (fails * (1 - follower->chance.answers) + reversed) / 2;
  const double later = step.slice * losses_.per_second;
  schedule.loss = chance.loss + fails * (follower->chance.loss + later) + missed * losses_.miss;
  return schedule;
}

std::vector<std::size_t> Scheduler::most_promising(const Cases::Weights& weights) const {
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < outlooks_.size(); ++i) {
    const auto chance = outlooks_[i].within(remaining_, losses_, weights);
    order.emplace_back(chance.loss + (1 - chance.answers) * losses_.miss, i);
  }
  const std::size_t count = std::min(kFirst, order.size());
  std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count), order.end());
  std::vector<std::size_t> first;
  for (std::size_t i = 0; i < count; ++i) first.push_back(order[i].second);
  return first;
}

// Whether its first slice is as safe as any.
bool Scheduler::is_cautious(const Step& step, const Cases::Weights& weights) const {
  const std::size_t count = outlooks_.size();
  if (count <= kSharers) return step.slice == remaining_ / static_cast<double>(count);
  if (step.slice == remaining_) return true;
  const Outlook& outlook = outlooks_[step.candidate];
  return step.slice >= std::max(remaining_ / 2, kHangs * outlook.longest()) &&
         outlook.within(remaining_, losses_, weights).answers <=
             outlook.within(step.slice, losses_, weights).answers + kNothing;
}

// The loss of a schedule that risks something: it is less than another's only if it is so clearly.
// Where an even share fails nearly always, no loss is clearly less; but a gain may be clearly more.
double Scheduler::doubted(double loss) const {
  if (outlooks_.size() > kSharers) return kClearlyOfMany * loss;
  const double gain = losses_.miss - loss;
  return std::max(loss, std::min(kClearlyOfFew * loss, losses_.miss - gain / kClearlyOfFew));
}

// The slice that is best for a first step of this candidate.
Schedule Scheduler::best_with(std::size_t candidate, const Cases::Weights& weights) const {
  Schedule best;
  double least = std::numeric_limits<double>::infinity();
  for (const double slice : slices(candidate)) {
    const Step step{candidate, slice};
    const Schedule schedule = try_pair(step, weights);
    const double loss = is_cautious(step, weights) ? schedule.loss : doubted(schedule.loss);
    if (loss >= least) continue;
    least = loss;
    best = schedule;
  }
  return best;
}

Schedule Scheduler::best(const Cases::Weights& weights) const {
  std::vector<Schedule> schedules;
  for (const std::size_t candidate : most_promising(weights))
    schedules.push_back(best_with(candidate, weights));
  return *std::min_element(
      schedules.begin(), schedules.end(),
      [](const Schedule& one, const Schedule& other) { return one.loss < other.loss; });
}

}  // namespace skein::entity
