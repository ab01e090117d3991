#include <optional>
#include <string>

#include "calls/benchmarks.hpp"
#include "command/bench/random_turns.hpp"
#include "harness/goals.hpp"

namespace skein::benchmarks {
namespace {

constexpr std::uint32_t kSeed = 29;

}  // namespace

std::vector<Comparison> compare_loans(Configurations& configurations, const LoanPlan& plan) {
  Outcome one;
  Outcome many;
  Outcome copied;
  std::optional<Running> running;
  const std::string count = std::to_string(plan.calls_per_turn);
  const auto take = [&](Outcome& outcome, const std::string& what) {
    const auto times = running->times(what + " " + count);
    outcome.samples.insert(outcome.samples.end(), times.begin(), times.end());
  };
  const Absence absence = attempt("calls that lend", [&] {
    running.emplace(configurations.skein_lending());
    running->place(Placement::OneCoreEach);
    for (const char* each : {"lend_one", "lend_many", "copy_one"})
      running->times(each + (" " + count));
    take_turns(plan.rounds,
               {[&] { take(one, "lend_one"); }, [&] { take(many, "lend_many"); },
                [&] { take(copied, "copy_one"); }},
               kSeed);
  });
  for (Outcome* const outcome : {&one, &many, &copied}) {
    outcome->absence = absence;
    outcome->rounds = plan.rounds;
  }
  std::vector<Comparison> comparisons;
  const auto compare = [&](std::size_t size, const std::string& rival, const Outcome& subject,
                           const Outcome& beside) {
    Comparison& comparison = comparisons.emplace_back(
        Comparison{kCallThatLends, "skein shared memory", rival, {{"size_bytes", size}}});
    fill(comparison, subject, beside);
  };
  compare(std::size_t{1} << 20, "a copy by memcpy", one, copied);
  compare(std::size_t{1} << 26, "limit 50 us", many, Outcome{{kLendingUs}});
  return comparisons;
}

}  // namespace skein::benchmarks
