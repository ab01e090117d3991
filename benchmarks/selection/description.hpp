#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace skein::benchmarks::selection {

/// A group of features that are computed together.
struct FeatureStep {
  std::vector<std::string> provides;
  std::vector<std::string> requires_steps;  ///< That have to be computed before.
};

/// What description.txt of an ASlib scenario says.
struct Description {
  std::string id;
  double cutoff_s = 0;
  std::string runtime;                  ///< The measure that is a runtime: a column of the runs.
  std::vector<std::string> algorithms;  ///< Sorted; empty if it lists none.
  std::map<std::string, FeatureStep> steps;  ///< Empty if it names none.
  std::vector<std::string> default_steps;    ///< Empty if it names none.
  /// Of features of algorithms, which are not read: of an algorithm its runs tell more.
  std::vector<std::string> algorithm_steps;

  /// The default steps, or else all, and those that they require, each once.
  std::vector<std::string> used_steps() const;
};

/// Throws InvalidArgument with the file, the line where there is one, the cause and the remedy.
Description read_description(const std::filesystem::path& file);

}  // namespace skein::benchmarks::selection
