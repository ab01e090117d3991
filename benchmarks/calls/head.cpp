#include <cmath>

#include "calls/benchmarks.hpp"
#include "command/bench/random_turns.hpp"
#include "harness/goals.hpp"

namespace skein::benchmarks {
namespace {

constexpr std::uint32_t kSeed = 23;

/// Both on the Body's thread, turn about: how long direct calls take, and tasks beyond the median
/// of those.
class Stage {
 public:
  Stage(Configurations& configurations, const HeadPlan& plan, std::size_t csps,
        const std::string& strategy)
      : plan_(plan), perform_("perform " + strategy + " " + std::to_string(plan.tasks)) {
    absence_ = attempt("the Head's peer", [&] {
      running_.emplace(configurations.skein_head());
      running_->place(Placement::OneCore);
      running_->times("bind " + std::to_string(csps));
      running_->times(perform_);
    });
  }

  Outcome measure() {
    std::vector<double> direct;
    Outcome outcome;
    if (!absence_) {
      absence_ = attempt("the Head's peer", [&] {
        for (std::size_t round = 0; round < plan_.rounds; ++round) {
          std::vector<double> tasks;
          take_turns(1,
                     {[&] { direct = running_->times("direct " + std::to_string(plan_.tasks)); },
                      [&] { tasks = running_->times(perform_); }},
                     kSeed + static_cast<std::uint32_t>(round));
          direct_us_ = summarize(direct).p50;
          for (const double task : tasks) outcome.samples.push_back(task - direct_us_);
        }
      });
    }
    outcome.absence = absence_;
    return outcome;
  }

  /// The median of the last round's direct calls.
  double direct_us() const { return direct_us_; }

 private:
  const HeadPlan plan_;
  const std::string perform_;
  std::optional<Running> running_;
  Absence absence_;
  double direct_us_ = 0;
};

}  // namespace

std::vector<Comparison> compare_head(Configurations& configurations, const HeadPlan& plan) {
  std::vector<Comparison> comparisons;
  const auto compare = [&](std::size_t csps, const std::string& strategy, const std::string& claim,
                           double limit_us) {
    Stage stage(configurations, plan, csps, strategy);
    const Outcome outcome = stage.measure();
    Comparison& comparison = comparisons.emplace_back(
        Comparison{claim,
                   "skein",
                   "limit " + std::to_string(std::lround(limit_us)) + " us",
                   {{"where", std::to_string(csps) + " CSPs, " + strategy},
                    {"direct_us", stage.direct_us()}}});
    fill(comparison, outcome, Outcome{{limit_us}});
  };
  compare(1, "declared", "Head and dispatch around a CSP in the process", kHeadUs);
  compare(4, "learned", "Head and dispatch with a decision by what was learned",
          kLearnedDecisionUs);
  return comparisons;
}

}  // namespace skein::benchmarks
