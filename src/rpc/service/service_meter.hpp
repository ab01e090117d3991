#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/latency_histogram.hpp"
#include "skein/detail/operation.hpp"

namespace skein::introspection {
struct OperationStatistics;
}

namespace skein::rpc {

/// What has become of the calls of one operation. Lock-free; idl/skein/introspection.idl explains
/// the counters.
struct OperationMeter {
  using Counter = std::atomic<std::uint64_t>;
  Counter received{0};
  Counter answered{0};
  Counter raised{0};
  Counter failed{0};
  Counter refused{0};
  Counter expired{0};
  LatencyHistogram waited;
  LatencyHistogram ran;

  static void count(Counter& counter) noexcept { counter.fetch_add(1, std::memory_order_relaxed); }
};

/// The meters of a service, one an operation; always on, of fixed size.
class ServiceMeter {
 public:
  explicit ServiceMeter(const InterfaceInfo& interface);

  /// The meter of an operation that the interface has, as it or a base of it names it.
  OperationMeter& of(const OperationInfo& operation) noexcept;

  /// Those that were called.
  std::vector<introspection::OperationStatistics> read() const;

 private:
  const InterfaceInfo& interface_;
  std::unique_ptr<OperationMeter[]> meters_;  // one more for what the interface does not have
};

}  // namespace skein::rpc
