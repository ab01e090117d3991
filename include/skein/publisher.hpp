#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "skein/detail/topic_type.hpp"
#include "skein/topic_qos.hpp"

namespace skein::dds {
class Participant;
}

namespace skein {

/// Counters since the publisher was made.
struct PublisherCounters {
  /// Values and disposals.
  std::uint64_t published = 0;
  /// Periods in which an instance had no value; see Qos::deadline.
  std::uint64_t missed_deadlines = 0;
};

namespace topics {

class Register;

/// A publisher without its type.
class TopicWriter {
 public:
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

}  // namespace topics

/// Publishes values of an IDL struct on a topic; made by Entity::publisher(). Thread-safe, movable:
/// one that was moved from throws InvalidArgument. Destroy it before its entity.
template <class T>
class [[nodiscard]] Publisher {
  static_assert(topics::kIsType<T>,
                "a topic carries values of an IDL struct or union; an interface is provided by "
                "Entity::provide() and called by Entity::connect()");

 public:
  /// In the systems that `qos` names, or in the partition "". Throws InvalidArgument for an invalid
  /// name or QoS, and for a name that the entity already uses with another type. `known` lists it
  /// for those who look at the entity, and must outlive it.
  Publisher(dds::Participant& participant, const std::string& name, const TopicQos& qos,
            topics::Register* known = nullptr)
      : writer_(std::make_unique<topics::TopicWriter>(participant, name, topics::topic_type<T>(),
                                                      qos, known)) {}

  /// Sends the value to all subscribers that are matched now, and keeps it for late joiners if the
  /// QoS say so. Throws Overloaded if reliable subscribers make no room within `max_blocking`,
  /// InvalidArgument for a value that CDR cannot carry. A value of more than 1 MiB that is
  /// published best effort is logged, the first time: it hardly arrives.
  void publish(const T& value) { topics::held(writer_).publish(&value); }

  /// Disposes the instance with this value's key. Throws as publish() does.
  void dispose(const T& value) requires Keyed<T> { topics::held(writer_).dispose(&value); }

  /// Waits until all reliable subscribers that are matched now have what was published; false where
  /// they have not by the timeout. Before a publisher goes: what they have not is lost then.
  bool wait_for_acknowledgments(std::chrono::milliseconds timeout) {
    return topics::held(writer_).wait_for_acknowledgments(timeout);
  }

  /// Number of subscribers that are matched now.
  std::size_t subscribers() const { return topics::held(writer_).subscribers(); }

  PublisherCounters counters() const { return topics::held(writer_).counters(); }

 private:
  std::unique_ptr<topics::TopicWriter> writer_;
};

}  // namespace skein
