#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "skein/core/executor.hpp"
#include "skein/topics/topic_qos.hpp"
#include "skein/topics/topic_type.hpp"

namespace skein {

/// Since the subscription was made.
struct SubscriptionCounters {
  /// Values and disposals that were handed to the user.
  std::uint64_t received = 0;
  /// Gave way to newer ones before the user took them.
  std::uint64_t dropped = 0;
  /// Came, or were taken, after their lifespan.
  std::uint64_t expired = 0;
  std::uint64_t malformed = 0;
  std::uint64_t missed_deadlines = 0;
};

/// What else a subscription tells; by default nothing. Where the callback runs.
struct SubscriptionOptions {
  /// Of keyed topics: an instance was disposed; `key` as key_hash() makes it.
  std::function<void(const Guid& key)> on_disposed{};
  /// No value of the instance came for a deadline. Keyless topics have one instance, of the nil
  /// key.
  std::function<void(const Guid& key)> on_deadline_missed{};
  /// Runs the callbacks of this subscription; nothing: the entity's own thread for topics. A
  /// callback that takes long should have one of its own: others wait for it. It outlives the
  /// subscription.
  Executor* executor = nullptr;
};

namespace topics {

/// A subscription without its type.
class TopicReader {
 public:
  /// What it does with a decoded value; without one, values wait until they are taken.
  using Consumer = std::function<void(const void* value)>;

  TopicReader(dds::Participant& participant, Executor& executor, const std::string& name,
              const TopicType& type, const TopicQos& qos, Consumer consumer,
              SubscriptionOptions options);
  ~TopicReader();
  /// Decodes the oldest value that waits into `value`; false where none does.
  bool take(void* value);
  std::size_t publishers() const;
  SubscriptionCounters counters() const;

 private:
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace topics

/// Receives the values of a topic; Entity::subscription() makes it. With a callback it is called on
/// the executor, one call at a time, oldest first; without one the user polls. Values wait in a
/// queue that the QoS bound (`history_depth` a key, `max_waiting` in all): a slow subscriber loses
/// its own oldest values, counted, and holds up nobody else. A sample that is no T is counted,
/// reported once and dropped.
///
/// Thread-safe, movable. Destroying it waits for a running callback: not from one. It must be gone
/// before its entity is.
template <class T>
class Subscription {
 public:
  using Callback = std::function<void(const T& value)>;

  /// In the systems that `qos` names, or in the partition "". Throws as Publisher does.
  Subscription(dds::Participant& participant, Executor& executor, const std::string& name,
               const TopicQos& qos, Callback callback, SubscriptionOptions options = {})
      : reader_(std::make_unique<topics::TopicReader>(
            participant, executor, name, topics::topic_type<T>(), qos,
            consumer_of(std::move(callback)), std::move(options))) {}

  /// The oldest value that waits. For subscriptions without a callback, as latest() is.
  std::optional<T> take() {
    T value{};
    return reader_->take(&value) ? std::optional<T>(std::move(value)) : std::nullopt;
  }

  /// The newest value that waits; older ones are passed over.
  std::optional<T> latest() {
    std::optional<T> newest = take();
    for (std::optional<T> next = newest; next; next = take()) newest = std::move(next);
    return newest;
  }

  /// How many publishers are matched now.
  std::size_t publishers() const { return reader_->publishers(); }

  SubscriptionCounters counters() const { return reader_->counters(); }

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
