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
  const TypeSupport& support = *type.support;
  const bool xcdr2 = is_xcdr2(support.representation);
  return {qos,
          xcdr2 ? dds::DataRepresentation::Xcdr2 : dds::DataRepresentation::Xcdr1,
          {support.description.signature, idl::growing_members(support), idl::type_text(support)},
          qos.systems};
}

}  // namespace skein::topics
