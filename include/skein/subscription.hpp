#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "skein/detail/topic_type.hpp"
#include "skein/executor.hpp"
#include "skein/topic_qos.hpp"

namespace skein::dds {
class Participant;
}

namespace skein {

/// Counters since the subscription was made.
struct SubscriptionCounters {
  /// Values and disposals that were passed to the user.
  std::uint64_t received = 0;
  /// Replaced by newer ones before the user took them.
  std::uint64_t dropped = 0;
  /// Arrived, or were taken, after their lifespan.
  std::uint64_t expired = 0;
  std::uint64_t malformed = 0;
  std::uint64_t missed_deadlines = 0;
};

/// Further callbacks of a subscription, and where its callbacks run.
struct SubscriptionOptions {
  /// Keyed topics: an instance was disposed; `key` is as key_hash() makes it. Without a value
  /// callback it runs inside take() and latest().
  std::function<void(const Guid& key)> on_disposed{};
  /// No value of the instance came within the deadline. A keyless topic has one instance, with the
  /// nil key.
  std::function<void(const Guid& key)> on_deadline_missed{};
  /// Runs the callbacks of this subscription; nullptr: the entity's own thread for topics. A slow
  /// callback should have its own executor, since others wait for it. The executor must outlive the
  /// subscription.
  Executor* executor = nullptr;
};

namespace topics {

class Register;

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

}  // namespace topics

/// Receives the values of a topic; made by Entity::subscription(). With a callback, the executor
/// calls it for one value at a time, oldest first; without one, the user polls. Values wait in a
/// queue that the QoS bound (`history_depth` per key, `max_waiting` in all): a slow subscriber
/// loses its own oldest values, which are counted, and does not delay the publisher. A sample that
/// is no T is dropped and counted; the first is logged. The first exception from a callback is
/// logged; the next value follows. Keep it: its callbacks end with it.
///
/// Thread-safe, movable: one that was moved from throws InvalidArgument. The destructor waits for a
/// running callback; do not destroy it from one. Destroy it before its entity.
template <class T>
class [[nodiscard]] Subscription {
  static_assert(topics::kIsType<T>,
                "a topic carries values of an IDL struct or union; an interface is provided by "
                "Entity::provide() and called by Entity::connect()");

 public:
  using Callback = std::function<void(const T& value)>;

  /// In the systems that `qos` names, or in the partition "". Throws as Publisher() does.
  Subscription(dds::Participant& participant, Executor& executor, const std::string& name,
               const TopicQos& qos, Callback callback, SubscriptionOptions options = {},
               topics::Register* known = nullptr)
      : reader_(std::make_unique<topics::TopicReader>(
            participant, executor, name, topics::topic_type<T>(), qos,
            consumer_of(std::move(callback)), std::move(options), known)) {}

  /// The oldest waiting value, or nullopt. Throws InvalidArgument, as latest() does, if the
  /// subscription has a callback.
  std::optional<T> take() {
    T value{};
    return topics::held(reader_).take(&value) ? std::optional<T>(std::move(value)) : std::nullopt;
  }

  /// The newest waiting value, or nullopt; older ones are dropped.
  std::optional<T> latest() {
    std::optional<T> newest = take();
    for (std::optional<T> next = newest; next; next = take()) newest = std::move(next);
    return newest;
  }

  /// Number of publishers that are matched now.
  std::size_t publishers() const { return topics::held(reader_).publishers(); }

  SubscriptionCounters counters() const { return topics::held(reader_).counters(); }

 private:
  static topics::TopicReader::Consumer consumer_of(Callback callback) {
    if (!callback) return nullptr;
    return [callback = std::move(callback)](const void* value) {
      callback(*static_cast<const T*>(value));
    };
  }

  std::unique_ptr<topics::TopicReader> reader_;
};

}  // namespace skein
