#pragma once

#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include "dds/port/port.hpp"

namespace skein::brokerless_discovery {

/// The topic of descriptions.
inline const dds::Topic& description_topic() {
  static const dds::Topic topic{"skein/services", "skein::discovery::ServiceDescription", true};
  return topic;
}

inline dds::Qos description_qos(std::vector<std::string> partitions,
                                std::chrono::milliseconds lease) {
  dds::Qos qos;
  qos.transient_local = true;
  qos.history_depth = 1;
  qos.liveliness_lease = lease;
  qos.partitions = std::move(partitions);
  return qos;
}

/// The partition of the services that `owner` manages, or, if there is none, of public ones.
inline std::string description_partition(const std::string& owner) {
  return owner.empty() ? "" : "managed/" + owner;
}

}  // namespace skein::brokerless_discovery
