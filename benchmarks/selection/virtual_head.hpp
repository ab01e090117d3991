#pragma once

#include <memory>
#include <string>
#include <vector>

#include "selection/scenario.hpp"
#include "skein/clock.hpp"
#include "skein/detail/history.hpp"

namespace skein::benchmarks::selection {

/// How a Head worked on an instance.
struct Answer {
  struct Attempt {
    std::size_t algorithm = 0;
    double slice_s = 0;
  };
  bool solved = false;
  double time_s = 0;  ///< In all, with the features if they were computed.
  std::vector<Attempt> attempts{};
  double decide_us = 0;  ///< Real time for predictions and choices.
};

/// A Head's selection and history in virtual time: a second of the scenario is one of Duration. Its
/// CSPs are the scenario's algorithms, which declare neither latency nor quality, and of which one
/// runs at a time.
class VirtualHead {
 public:
  /// The share of decisions that may explore is as HeadOptions has it; it explores only if it
  /// learns as it decides. `clock` measures decide_us. The scenario and the clock must outlive
  /// this. Throws InvalidArgument for an unknown strategy.
  VirtualHead(const Scenario& scenario, const std::string& strategy, const Clock& clock);

  /// Adds what every algorithm made of this instance to the history.
  void teach(const Instance& instance);
  /// Learns from all that has been added.
  void learn();

  /// Runs algorithms until one solves the instance, or none or no time is left. The features cost
  /// time if the strategy reads the history. If `learns`, each attempt is added to the history,
  /// which learns when a Head's would.
  Answer decide(const Instance& instance, bool learns);

 private:
  std::vector<Candidate> candidates(const Features& features) const;
  struct Ending {
    bool solved;
    bool late;  ///< It would have taken longer than its slice.
    Duration took;
  };
  static Ending run(const AlgorithmRun& run, Duration slice);
  void remember(const Candidate& candidate, const Ending& ending,
                const std::shared_ptr<const Features>& features, std::uint32_t after);

  const Scenario& scenario_;
  std::shared_ptr<const SelectionStrategy> strategy_;
  const Clock& clock_;
  History history_;
};

}  // namespace skein::benchmarks::selection
