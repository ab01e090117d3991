#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "skein/detail/history.hpp"

namespace skein::entity {

/// The requests on which candidates have run, numbered from 0, with the weight of each: how much it
/// is like the present one, of which it is known who has failed.
class Cases {
 public:
  /// Those of all candidates; each counts 1.
  explicit Cases(std::size_t runs);
  std::uint32_t index_of(std::uint64_t request);

  using Weights = std::vector<float>;
  Weights weights() const { return Weights(count_, 1.0f); }

 private:
  std::vector<std::pair<std::uint64_t, std::uint32_t>> slots_;  // a hash table, half full
  std::uint32_t count_ = 0;
};

/// What a result is worth: the loss of a late, a poor and a missing one. Seconds.
struct Losses {
  Losses(const Situation& situation, std::span<const Candidate> candidates);

  double miss = 0;
  double per_second = 0;
  double per_quality = 0;  ///< For each 1 below the best quality.
  double best_quality = 0;
  double poor = 0;  ///< Below good_enough.
  double good_enough = 0;

  double of_quality(double quality) const;
};

/// What is expected of a CSP for the present request: by its runs on similar ones, and by what it
/// declares. Times are in seconds.
class Outlook {
 public:
  Outlook(const Candidate& candidate, const Losses& losses, Cases& cases);

  /// Of an answer within a slice.
  struct Chance {
    double answers = 0;  ///< Probability.
    double loss = 0;     ///< Expected loss by time and quality, times that probability.
  };
  Chance within(double slice, const Losses& losses, const Cases::Weights& weights) const;

  /// The weights if it has not answered within the slice, for which its chance was `answers`.
  Cases::Weights after_failing(double slice, double answers, const Cases::Weights& weights) const;

  /// Similar requests that are as likely as any to be like the present one, and those of them that
  /// it answered within the slice.
  struct Count {
    std::size_t answered = 0;
    std::size_t known = 0;
  };
  Count count(double slice, const Cases::Weights& weights) const;

  bool has_run() const { return count_ > 0; }
  /// Time to an answer: of half of the answers, and of all; the declared one if there are none, and
  /// if that is missing 0.
  double typical() const;
  double longest() const { return longest_; }

 private:
  struct Run {
    float took;
    float answer;  // when it answered; never: infinity
    float weight;
    float quality_loss;
    std::uint32_t request;
    bool late;
    // Of a late one: runs that took longer, and answers that came sooner.
    float before = 0;
    float share = 0;
  };
  class Answers;
  double prior(double slice) const;
  void rank();

  std::array<Run, History::kListed> runs_;
  std::size_t count_ = 0;
  std::size_t first_late_ = 0;
  double declared_ = 0;  // 0: not declared
  double declared_loss_ = 0;
  double longest_ = 0;
};

}  // namespace skein::entity
