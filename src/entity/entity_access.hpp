#pragma once

#include <memory>
#include <string>
#include <utility>

#include "skein/entity.hpp"

namespace skein {

/// What Skein's own libraries and tools need of an entity, beyond what users may.
struct EntityAccess {
  static dds::Participant& participant(Entity& entity) noexcept;
  /// As Entity::publisher() and subscription(), of a type that is known at run time alone.
  static std::unique_ptr<topics::TopicWriter> topic_writer(Entity& entity, const std::string& name,
                                                           const topics::TopicType& type,
                                                           const TopicQos& qos) {
    return entity.topic_writer(name, type, qos);
  }
  static std::unique_ptr<topics::TopicReader> topic_reader(Entity& entity, const std::string& name,
                                                           const topics::TopicType& type,
                                                           const TopicQos& qos,
                                                           topics::TopicReader::Consumer consumer,
                                                           SubscriptionOptions options) {
    return entity.topic_reader(name, type, qos, std::move(consumer), std::move(options));
  }
};

}  // namespace skein
