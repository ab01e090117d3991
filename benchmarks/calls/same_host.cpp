#include "calls/benchmarks.hpp"
#include "calls/contest.hpp"
#include "harness/goals.hpp"

namespace skein::benchmarks {

std::vector<Comparison> compare_same_host(Configurations& configurations, const CallPlan& plan) {
  std::vector<Trial> trials;
  for (const auto& size : plan.sizes) {
    trials.push_back(closed_loop(kCallThroughSharedMemory, size.size_bytes, size.calls_per_turn));
    // With pauses both sides fall asleep between calls, and processors rest.
    trials.push_back(paced(kCallThroughSharedMemory, size.calls_per_turn / 10 + 1, 1'000));
    trials.push_back(paced(kCallThroughSharedMemory, size.calls_per_turn / 100 + 1, 10'000));
  }
  Contest contest("same host", std::move(trials));
  using Memory = Configurations::SharedMemory;
  const std::vector<Configuration> subjects{configurations.skein_same_host(Memory::Sleeping),
                                            configurations.skein_same_host(Memory::Spinning)};
  const std::vector<Configuration> rivals{
      configurations.skein("fastdds", "fastdds"), configurations.rival("omniorb", "unix"),
      configurations.rival("omniorb", "tcp"), configurations.unix_socket(),
      configurations.shared_memory()};
  for (const auto* entering : {&subjects, &rivals}) {
    for (const Configuration& each : *entering) contest.enter(each);
  }
  contest.run(plan.rounds);
  std::vector<Comparison> comparisons;
  for (const Configuration& subject : subjects) {
    for (const Configuration& rival : rivals)
      append(comparisons, contest.compare(subject.name, rival.name));
  }
  append(comparisons, contest.compare(subjects.back().name, Limit{"limit 1 us", kSpinningCallUs}));
  return comparisons;
}

}  // namespace skein::benchmarks
