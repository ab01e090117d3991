#include "core/latency_histogram.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace skein {
namespace {

constexpr auto kRelaxed = std::memory_order_relaxed;

Duration to_duration(std::uint64_t nanoseconds) {
  return std::chrono::nanoseconds(static_cast<std::int64_t>(nanoseconds));
}

}  // namespace

// Below 16 each value has a bucket of its own; above, the four leading bits tell.
std::size_t LatencyHistogram::bucket_of(std::uint64_t nanoseconds) noexcept {
  const std::size_t width = std::bit_width(nanoseconds);
  const std::size_t shift = width > kStepBits + 1 ? width - kStepBits - 1 : 0;
  return (shift << kStepBits) + static_cast<std::size_t>(nanoseconds >> shift);
}

std::uint64_t LatencyHistogram::upper_edge(std::size_t bucket) noexcept {
  const std::size_t shift = bucket < (2u << kStepBits) ? 0 : (bucket >> kStepBits) - 1;
  return ((bucket - (shift << kStepBits) + 1) << shift) - 1;
}

void LatencyHistogram::record(Duration duration) noexcept {
  constexpr std::int64_t kMax = (std::int64_t{1} << kBits) - 1;
  const auto count = std::chrono::duration_cast<std::chrono::nanoseconds>(duration).count();
  const auto nanoseconds = static_cast<std::uint64_t>(std::clamp<std::int64_t>(count, 0, kMax));
  buckets_[bucket_of(nanoseconds)].fetch_add(1, kRelaxed);
  sum_.fetch_add(nanoseconds, kRelaxed);
  std::uint64_t greatest = greatest_.load(kRelaxed);
  while (nanoseconds > greatest &&
         !greatest_.compare_exchange_weak(greatest, nanoseconds, kRelaxed)) {
  }
}

LatencySummary LatencyHistogram::summary() const noexcept {
  std::array<std::uint64_t, kBuckets> counts;
  std::uint64_t total = 0;
  for (std::size_t i = 0; i < kBuckets; ++i) total += counts[i] = buckets_[i].load(kRelaxed);
  LatencySummary summary;
  if (total == 0) return summary;
  const std::uint64_t greatest = greatest_.load(kRelaxed);
  const auto percentile = [&](double share) {
    const auto rank = static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(total)));
    std::uint64_t seen = 0;
    std::size_t bucket = 0;
    while (bucket + 1 < kBuckets && (seen += counts[bucket]) < rank) ++bucket;
    return to_duration(std::min(upper_edge(bucket), greatest));
  };
  summary.count = total;
  summary.mean = to_duration(sum_.load(kRelaxed) / total);
  summary.p50 = percentile(0.50);
  summary.p90 = percentile(0.90);
  summary.p99 = percentile(0.99);
  summary.greatest = to_duration(greatest);
  return summary;
}

}  // namespace skein
