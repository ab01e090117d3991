#pragma once

#include <map>
#include <string>
#include <vector>

#include "decisions/contestant.hpp"

namespace skein::benchmarks {

/// One request, and what each contestant made of it.
struct Trial {
  const Request* request = nullptr;
  std::map<std::string, Answer> answers;
  std::map<std::string, bool> valid;  ///< By the independent judge, of those with a route.

  /// Time to a valid answer where it came in time, else ten times the limit; milliseconds.
  double par10(const std::string& contestant) const;
  bool solved_by(const std::string& contestant) const;
  /// The algorithm with the least PAR10, alone.
  const std::string& virtual_best() const;
};

/// Means over a part's trials.
struct Scores {
  std::string single_best;  ///< The algorithm with the least PAR10 in the training part.
  double virtual_best_ms = 0;
  double single_best_ms = 0;

  double contestant_ms = 0;
  std::size_t requests = 0;
  std::size_t solvable = 0;  ///< By any algorithm alone.
  std::size_t missed = 0;    ///< No valid answer in time.
  std::size_t accepted = 0;
  std::size_t invalid = 0;  ///< Accepted, and wrong by the independent judge.

  /// 0: as good as the single best; 1: as good as the virtual best.
  double gap_closed() const {
    return (single_best_ms - contestant_ms) / (single_best_ms - virtual_best_ms);
  }
};

std::string single_best_of(const std::vector<Trial>& trials);

Scores scores_of(const std::string& contestant, const std::vector<Trial>& trials,
                 const std::string& part);

}  // namespace skein::benchmarks
