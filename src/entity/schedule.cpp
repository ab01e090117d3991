#include "schedule.hpp"

#include <algorithm>

#include "slice.hpp"

namespace skein::entity {
namespace {

// A slice beyond what was ever seen: the next request may be somewhat harder, the machine busier.
constexpr double kStretch = 1.5;
constexpr double kLoad = 0.005;
// How many times less loss a schedule must promise than one that risks nothing new: what is best of
// many by few runs is seldom as good as it looks. Among few, an even share is what risks least;
// among many, all of the time, or a slice that costs the first one next to nothing.
constexpr double kClearlyOfFew = 1.4;
constexpr double kClearlyOfMany = 1.6;
constexpr double kNothing = 0.01;
// First steps are tried of so many candidates; a further step is looked at for so many schedules.
constexpr std::size_t kFirst = 6;
constexpr std::size_t kLooks = 3;
// Among how many the time is shared evenly at most.
constexpr std::size_t kSharers = 3;

}  // namespace

Scheduler::Scheduler(std::span<const Outlook> outlooks, const Losses& losses, double remaining)
    : outlooks_(outlooks), losses_(losses), remaining_(remaining) {}

// An even share first.
std::vector<double> Scheduler::slices(std::size_t candidate, double left,
                                      std::size_t others) const {
  if (others == 0) return {left};
  const Outlook& outlook = outlooks_[candidate];
  std::vector<double> slices{left / static_cast<double>(std::min(others + 1, kSharers))};
  for (const double slice : {left, left / 2, kStretch * outlook.longest() + kLoad,
                             kStretch * outlook.typical() + kLoad}) {
    if (slice > left) continue;
    const bool near = std::any_of(slices.begin(), slices.end(), [&](double known) {
      return slice > 0.9 * known && slice < 1.1 * known;
    });
    if (!near) slices.push_back(slice);
  }
  return slices;
}

std::optional<Scheduler::Follower> Scheduler::best_follower(const Cases::Weights& weights,
                                                            const Asked& asked, double left) const {
  std::optional<Follower> best;
  for (std::size_t i = 0; i < outlooks_.size(); ++i) {
    if (asked[i]) continue;
    const auto chance = outlooks_[i].within(left, losses_, weights);
    const double loss = chance.loss + (1 - chance.answers) * losses_.miss;
    if (!best || loss < best->loss) best = {i, loss, chance};
  }
  return best;
}

Schedule Scheduler::try_pair(const Step& step, const Cases::Weights& weights, const Asked& asked,
                             double left) const {
  const Outlook& outlook = outlooks_[step.candidate];
  const auto chance = outlook.within(step.slice, losses_, weights);
  const double fails = 1 - chance.answers;
  Schedule schedule{step, std::nullopt, chance.loss + fails * losses_.miss};
  if (step.slice >= left) return schedule;
  Asked others = asked;
  others[step.candidate] = true;
  const double rest = left - step.slice;
  const auto after = outlook.after_failing(step.slice, chance.answers, weights);
  const auto follower = best_follower(after, others, rest);
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

// The second one need not get all of the time that is left.
Schedule Scheduler::look_further(const Schedule& pair, const Cases::Weights& weights) const {
  if (!pair.second || outlooks_.size() < 3) return pair;
  const Outlook& outlook = outlooks_[pair.first.candidate];
  const auto chance = outlook.within(pair.first.slice, losses_, weights);
  const auto after = outlook.after_failing(pair.first.slice, chance.answers, weights);
  const double left = remaining_ - pair.first.slice;
  Asked asked(outlooks_.size(), false);
  asked[pair.first.candidate] = true;
  Schedule best = pair;
  for (const double slice : {left / 2, kStretch * outlooks_[*pair.second].longest() + kLoad}) {
    if (slice >= left) continue;
    const Schedule rest = try_pair({*pair.second, slice}, after, asked, left);
    const double otherwise = rest.loss + pair.first.slice * losses_.per_second;
    const double loss = chance.loss + (1 - chance.answers) * otherwise;
    if (loss < best.loss) best.loss = loss;
  }
  return best;
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

Schedule Scheduler::best(const Cases::Weights& weights) const {
  const Asked nobody(outlooks_.size(), false);
  const double clearly = outlooks_.size() <= kSharers ? kClearlyOfFew : kClearlyOfMany;
  std::vector<std::pair<double, Schedule>> found;  // by loss, times what it must be better
  for (const std::size_t candidate : most_promising(weights)) {
    for (const double slice : slices(candidate, remaining_, outlooks_.size() - 1)) {
      const Step step{candidate, slice};
      const Schedule schedule = try_pair(step, weights, nobody, remaining_);
      const double factor = is_cautious(step, weights) ? 1 : clearly;
      found.emplace_back(factor * schedule.loss, schedule);
    }
  }
  const auto by_loss = [](const auto& a, const auto& b) { return a.first < b.first; };
  std::stable_sort(found.begin(), found.end(), by_loss);
  for (std::size_t i = 0; i < std::min(kLooks, found.size()); ++i) {
    auto& [loss, schedule] = found[i];
    const Schedule further = look_further(schedule, weights);
    loss *= further.loss / schedule.loss;
    schedule = further;
  }
  return std::min_element(found.begin(), found.end(), by_loss)->second;
}

}  // namespace skein::entity
