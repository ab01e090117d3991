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

/// Finds the schedule of least expected loss among those of two steps, and looks a step further
/// where that may change the order.
class Scheduler {
 public:
  /// The arguments must outlive it. `remaining` in seconds.
  Scheduler(std::span<const Outlook> outlooks, const Losses& losses, double remaining);

  Schedule best(const Cases::Weights& weights) const;

 private:
  struct Follower {
    std::size_t candidate = SIZE_MAX;
    double loss = 0;  // with all of the time that is left
    Outlook::Chance chance{};
  };
  /// Who has not been asked, as a bit each.
  using Asked = std::vector<bool>;

  bool is_cautious(const Step& step, const Cases::Weights& weights) const;
  std::vector<double> slices(std::size_t candidate, double left, std::size_t others) const;
  Schedule try_pair(const Step& step, const Cases::Weights& weights, const Asked& asked,
                    double left) const;
  Schedule look_further(const Schedule& pair, const Cases::Weights& weights) const;
  std::optional<Follower> best_follower(const Cases::Weights& weights, const Asked& asked,
                                        double left) const;
  std::vector<std::size_t> most_promising(const Cases::Weights& weights) const;

  std::span<const Outlook> outlooks_;
  const Losses& losses_;
  double remaining_;
};

}  // namespace skein::entity
