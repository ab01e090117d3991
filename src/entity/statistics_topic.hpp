#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include "dds/port/port.hpp"
#include "rpc/service/introspection_topic.hpp"
#include "skein/clock.hpp"
#include "skein/executor.hpp"

namespace skein::introspection {

/// Tells what an entity's services have done, on the topic `skein/statistics`: once a second, best
/// effort, and only while somebody reads it.
class StatisticsTopic {
 public:
  using Source = std::function<std::vector<ServiceStatistics>()>;

  /// `participant`, `clock` and `control`, on which `source` is asked, outlive the topic.
  StatisticsTopic(dds::Participant& participant, Clock& clock, Executor& control, Source source);
  /// `source` is not being asked any more when it returns. Not from a task of `control`.
  ~StatisticsTopic();

 private:
  void begin();
  void tick();

  Clock& clock_;
  const Source source_;
  std::mutex mutex_;
  bool ticking_ = false;
  bool closed_ = false;
  TimerId timer_ = 0;
  Publisher<ServiceStatistics> publisher_;  // last: goes first, and waits for a tick that runs
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
