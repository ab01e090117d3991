#pragma once

#include "skein/detail/topic_type.hpp"
#include "skein/topic_qos.hpp"

namespace skein::topics {

inline dds::Topic wire_topic(const std::string& name, const TopicType& type) {
  return {name, std::string(type.support->name), type.key_of != nullptr};
}

inline dds::Qos wire_qos(const TopicQos& qos) {
  dds::Qos result = qos;
  result.partitions = qos.systems;
  return result;
}

}  // namespace skein::topics
