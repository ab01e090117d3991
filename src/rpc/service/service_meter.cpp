#include "rpc/service/service_meter.hpp"

#include "skein/introspection.idl.hpp"

namespace skein::rpc {
namespace {

introspection::Latency latency_of(const LatencyHistogram& histogram) {
  const LatencySummary summary = histogram.summary();
  const auto count = [](Duration duration) {
    return static_cast<std::uint64_t>(
        std::chrono::duration_cast<std::chrono::nanoseconds>(duration).count());
  };
  return {summary.count,      count(summary.mean), count(summary.p50),
          count(summary.p90), count(summary.p99),  count(summary.greatest)};
}

}  // namespace

ServiceMeter::ServiceMeter(const InterfaceInfo& interface)
    : interface_(interface),
      meters_(std::make_unique<OperationMeter[]>(interface.operations.size() + 1)) {}

OperationMeter& ServiceMeter::of(const OperationInfo& operation) noexcept {
  std::size_t index = 0;
  for (const OperationInfo& known : interface_.operations) {
    if (known.hash == operation.hash) break;
    ++index;
  }
  return meters_[index];
}

std::vector<introspection::OperationStatistics> ServiceMeter::read() const {
  std::vector<introspection::OperationStatistics> read;
  for (std::size_t i = 0; i < interface_.operations.size(); ++i) {
    const OperationMeter& meter = meters_[i];
    if (meter.received == 0) continue;
    read.push_back({std::string(interface_.operations[i].name), meter.received, meter.answered,
                    meter.raised, meter.failed, meter.refused, meter.expired,
                    latency_of(meter.waited), latency_of(meter.ran)});
  }
  return read;
}

}  // namespace skein::rpc
