#pragma once

#include <functional>
#include <memory>
#include <string>

#include "skein/topics/topic_qos.hpp"
#include "skein/topics/topic_type.hpp"

namespace skein {

/// Since the publisher was made.
struct PublisherCounters {
  /// Values and disposals.
  std::uint64_t published = 0;
  std::uint64_t missed_deadlines = 0;
};

namespace topics {

/// A publisher without its type.
class TopicWriter {
 public:
  TopicWriter(dds::Participant& participant, const std::string& name, const TopicType& type,
              const TopicQos& qos);
  ~TopicWriter();
  void publish(const void* value);
  void dispose(const void* value);
  std::size_t subscribers() const;
  PublisherCounters counters() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace topics

/// Publishes values of a struct from IDL on a topic; Entity::publisher() makes it. Thread-safe. It
/// must be gone before its entity is. Movable.
template <class T>
class Publisher {
 public:
  /// In the systems that `qos` names, or in the partition "". Throws InvalidArgument for a name or
  /// QoS that is none, or a name that the entity already uses with another type.
  Publisher(dds::Participant& participant, const std::string& name, const TopicQos& qos)
      : writer_(std::make_unique<topics::TopicWriter>(participant, name, topics::topic_type<T>(),
                                                      qos)) {}

  /// Hands the value to all subscribers that are matched now, and keeps it for those to come where
  /// the QoS say so. Throws Overloaded where reliable subscribers have not made room within
  /// `max_blocking`, InvalidArgument for a value that CDR cannot carry.
  void publish(const T& value) { writer_->publish(&value); }

  /// Ends the instance that has this value's key.
  void dispose(const T& value) requires Keyed<T> { writer_->dispose(&value); }

  /// How many subscribers are matched now.
  std::size_t subscribers() const { return writer_->subscribers(); }

  PublisherCounters counters() const { return writer_->counters(); }

 private:
  std::unique_ptr<topics::TopicWriter> writer_;
};

}  // namespace skein
