#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "skein/clock.hpp"

namespace skein {

/// What a histogram holds, in figures. Percentiles are at most an eighth too high, never too low.
struct LatencySummary {
  std::uint64_t count = 0;
  Duration mean{};
  Duration p50{};
  Duration p90{};
  Duration p99{};
  Duration greatest{};
};

/// Counts durations from nanoseconds to 18 minutes (longer ones as such) in buckets of logarithmic
/// size with eight linear steps each: 2.5 kB, whatever happens. Recording takes no lock and may be
/// done by several threads; a summary read meanwhile may miss what is being recorded.
class LatencyHistogram {
 public:
  void record(Duration duration) noexcept;
  LatencySummary summary() const noexcept;

 private:
  static constexpr std::size_t kBits = 40;
  static constexpr std::size_t kStepBits = 3;
  static constexpr std::size_t kBuckets = (kBits - kStepBits + 1) << kStepBits;

  static std::size_t bucket_of(std::uint64_t nanoseconds) noexcept;
  static std::uint64_t upper_edge(std::size_t bucket) noexcept;

  std::array<std::atomic<std::uint64_t>, kBuckets> buckets_{};
  std::atomic<std::uint64_t> sum_{0};
  std::atomic<std::uint64_t> greatest_{0};
};

}  // namespace skein
