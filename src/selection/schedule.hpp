#pragma once

#include <optional>
#include <span>

#include "outlook.hpp"

namespace skein::entity {

/// A candidate, by its index, and how long it may take. Seconds.
struct Step {
  std::size_t candidate = 0;
  double slice = 0;
};

/// The first steps of a schedule.
struct Schedule {
  Step first;
  std::optional<std::size_t> second;  ///< Who follows, if the first one fails.
  double loss = 0;                    ///< Expected.
};

/// Finds the schedule of least expected loss among those of two steps; what follows is decided when
/// the first has failed.
class Scheduler {
 public:
  /// Among how many the time is shared evenly at most.
  static constexpr std::size_t kSharers = 3;

  /// The arguments must outlive it. `remaining` in seconds.
  Scheduler(std::span<const Outlook> outlooks, const Losses& losses, double remaining);

  Schedule best(const Cases::Weights& weights) const;

 private:
  struct Follower {
    std::size_t candidate = SIZE_MAX;
    double loss = 0;  // with all of the time that is left
    Outlook::Chance chance{};
  };

  double doubted(double loss) const;
  bool is_cautious(const Step& step, const Cases::Weights& weights) const;
  std::vector<double> slices(std::size_t candidate) const;
  Schedule best_with(std::size_t candidate, const Cases::Weights& weights) const;
  Schedule try_pair(const Step& step, const Cases::Weights& weights) const;
  std::optional<Follower> best_follower(const Cases::Weights& weights, std::size_t first,
                                        double left) const;
  std::vector<std::size_t> most_promising(const Cases::Weights& weights) const;

  std::span<const Outlook> outlooks_;
  const Losses& losses_;
  double remaining_;
};

}  // namespace skein::entity
