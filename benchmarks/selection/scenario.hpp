#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace skein::benchmarks::selection {

/// What an algorithm made of an instance.
struct AlgorithmRun {
  bool known = false;   ///< Whether the scenario has it.
  bool solved = false;  ///< Status `ok`, in less than the cutoff.
  /// Not solved by the cutoff, as opposed to given up before (crash, memout and so on).
  bool late = false;
  double time_s = 0;  ///< To the solution or to its end; at most the cutoff.
};

/// An instance of the problem, with what is known about it.
struct Instance {
  std::string name;
  int fold = 0;
  std::vector<AlgorithmRun> runs;                          ///< In the order of the algorithms.
  std::vector<std::pair<std::string, double>> features{};  ///< Without those that are missing.
  double features_cost_s = 0;                              ///< Time to compute the features.
  bool presolved = false;  ///< Solved while the features were computed, at their cost.
};

/// A scenario of ASlib (Bischl et al. 2016, "ASlib: A benchmark library for algorithm selection"),
/// with the features of its default steps, and of the steps that these require.
struct Scenario {
  std::string id;
  double cutoff_s = 0;
  std::vector<std::string> algorithms;  ///< Sorted.
  std::vector<Instance> instances;      ///< In the order of algorithm_runs.arff.
  std::vector<std::string> notes{};     ///< What is left out, and why.

  /// Time to the solution, or ten times the cutoff; seconds.
  double par10(const AlgorithmRun& run) const { return run.solved ? run.time_s : 10 * cutoff_s; }
  /// The algorithm with the least sum of PAR10 over all instances.
  std::size_t single_best() const;
  /// The algorithm with the least PAR10 on this instance.
  std::size_t virtual_best(const Instance& instance) const;
};

/// Reads a folder with description.txt, algorithm_runs.arff, feature_values.arff and cv.arff, of
/// which it takes the first repetition; feature_costs.arff and feature_runstatus.arff may be
/// absent. Of several repetitions of a run the mean time counts, and it is solved if all are; costs
/// and features count by their mean, too. Instances without a run or a fold are left out. aslib.py
/// does the reading. Throws InvalidArgument with the file, the line if there is one, the cause and
/// the remedy; also if the scenario measures no runtime or has no cutoff.
Scenario read_scenario(const std::filesystem::path& folder);

}  // namespace skein::benchmarks::selection
