#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "dds/port/port.hpp"
#include "rpc/service/introspection_topic.hpp"

namespace skein::introspection {

/// Reads the topic `skein/statistics`, of all entities of the domain whatever their vendor: for
/// tools. Thread-safe.
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
