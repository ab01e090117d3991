#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "selection/virtual_head.hpp"

namespace skein::benchmarks::selection {

/// Means over all instances, in seconds; decide_us is a median.
struct SelectionScores {
  double par10 = 0;
  double virtual_best = 0;
  double single_best = 0;
  double attempts = 0;
  double decide_us = 0;
  /// 0: as good as the single best; 1: as good as the virtual best; not finite if these are equal.
  double gap_closed() const { return (single_best - par10) / (single_best - virtual_best); }
};

/// Each instance is decided by a Head that has learned from all instances of other folds, and from
/// nothing else. Answers in the order of the instances.
std::vector<Answer> replay_folds(const Scenario& scenario, const std::string& strategy,
                                 const Clock& clock);

/// One Head decides all instances in a random order, which is the same every time, and learns from
/// its own attempts only. Answers in the order of the instances.
std::vector<Answer> replay_online(const Scenario& scenario, const std::string& strategy,
                                  const Clock& clock);

/// The numbers below `count` in a random order that depends on nothing else.
std::vector<std::size_t> shuffled(std::size_t count);

/// PAR10 of an answer: its time, or ten times the cutoff; seconds.
double par10(const Scenario& scenario, const Answer& answer);

SelectionScores scores_of(const Scenario& scenario, const std::vector<Answer>& answers);

/// A row per instance: what was tried, and the best algorithm, if any solves it. Throws
/// InvalidArgument if the file cannot be written.
void write_answers(const std::filesystem::path& csv, const Scenario& scenario,
                   const std::vector<Answer>& answers);

}  // namespace skein::benchmarks::selection
