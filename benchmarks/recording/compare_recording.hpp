#pragma once

#include "calls/benchmarks.hpp"

/// What recordings cost those who are recorded, and how much of it they take in.
namespace skein::benchmarks {

/// A call while a third process records it, beside one that nobody records.
std::vector<Comparison> compare_recorded_calls(Configurations& configurations,
                                               const CallPlan& plan);

/// Values that are published as fast as they go, reliably and not, in turns of so many.
struct TopicPlan {
  struct Size {
    std::size_t size_bytes;
    std::size_t values_per_turn;
  };
  std::vector<Size> sizes;
  std::size_t rounds;
};

/// The time by the number of those that are in the recording, beside one by the number that a
/// subscriber counted which does nothing else.
std::vector<Comparison> compare_recorded_topics(Configurations& configurations,
                                                const TopicPlan& plan);

}  // namespace skein::benchmarks
