#pragma once

#include "idl/types/growing_members.hpp"
#include "idl/types/type_text.hpp"
#include "skein/detail/topic_type.hpp"
#include "skein/topic_qos.hpp"

namespace skein::topics {

inline dds::Topic wire_topic(const std::string& name, const TopicType& type) {
  return {name, std::string(type.support->name), type.key_of != nullptr};
}

inline dds::Qos wire_qos(const TopicQos& qos, const TopicType& type) {
  dds::Qos result = qos;
  if (is_xcdr2(type.support->representation)) {
    result.representation = dds::DataRepresentation::Xcdr2;
  }
  result.type = {type.support->description.signature, idl::growing_members(*type.support),
                 idl::type_text(*type.support)};
  result.partitions = qos.systems;
  return result;
}

}  // namespace skein::topics
