#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "skein/detail/topic_type.hpp"
#include "skein/executor.hpp"
#include "skein/guid.hpp"
#include "skein/topic_qos.hpp"

namespace skein::dds {
class Participant;
}

namespace skein {

struct PublisherCounters;
struct SubscriptionCounters;
struct SubscriptionOptions;

namespace topics {

class Register;

/// A publisher without its type.
class TopicWriter {
 public:
  /// In the systems that `qos` names, or in the partition "". Throws InvalidArgument for an invalid
  /// name or QoS, and for a name that the participant already uses with another type. `known`, if
  /// any, lists it for those who look at the entity, and outlives it; the same for TopicReader.
  TopicWriter(dds::Participant& participant, const std::string& name, const TopicType& type,
              const TopicQos& qos, Register* known);
  ~TopicWriter();
  void publish(const void* value);
  void publish(std::span<const std::byte> message, const Guid& key);
  void dispose(const void* value);
  bool wait_for_acknowledgments(std::chrono::milliseconds timeout);
  std::size_t subscribers() const;
  PublisherCounters counters() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// A subscription without its type.
class TopicReader {
 public:
  /// Called with each decoded value; without one, values wait until they are taken.
  using Consumer = std::function<void(const void* value)>;

  TopicReader(dds::Participant& participant, Executor& executor, const std::string& name,
              const TopicType& type, const TopicQos& qos, Consumer consumer,
              SubscriptionOptions options, Register* known);
  ~TopicReader();
  /// Decodes the oldest waiting value into `value`; false if none waits. Throws InvalidArgument if
  /// there is a consumer.
  bool take(void* value);
  std::size_t publishers() const;
  SubscriptionCounters counters() const;

 private:
  struct State;
  std::shared_ptr<State> state_;
};

template <class T>
TopicReader::Consumer consumer_of(std::function<void(const T&)> callback) {
  if (!callback) return nullptr;
  return [callback = std::move(callback)](const void* value) {
    callback(*static_cast<const T*>(value));
  };
}

}  // namespace topics
}  // namespace skein
