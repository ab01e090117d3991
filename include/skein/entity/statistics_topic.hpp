#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "skein/core/clock.hpp"
#include "skein/core/executor.hpp"
#include "skein/dds/port.hpp"

namespace skein::introspection {

struct ServiceStatistics;

/// Tells what an entity's services have done, on the topic `skein/statistics`: once a second, best
/// effort, and only while somebody reads it.
class StatisticsTopic {
 public:
  using Source = std::function<std::vector<ServiceStatistics>()>;

  /// `participant`, `clock` and `control`, on which `source` is asked, outlive the topic.
  StatisticsTopic(dds::Participant& participant, Clock& clock, Executor& control, Source source);
  ~StatisticsTopic();

 private:
  struct State;
  std::shared_ptr<State> state_;
};

/// Reads that topic, of all entities of the domain whatever their vendor: for tools. Thread-safe.
class StatisticsReader {
 public:
  /// `participant` outlives the reader.
  explicit StatisticsReader(dds::Participant& participant);
  ~StatisticsReader();

  /// The last word of each service, by system, entity and service.
  std::vector<ServiceStatistics> latest() const;

  /// Samples that were not believed, since the start: malformed, of another participant's service,
  /// or without room. The log names the first.
  std::uint64_t refused() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace skein::introspection
