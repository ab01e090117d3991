#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "skein/detail/topic_ends.hpp"
#include "skein/executor.hpp"
#include "skein/guid.hpp"
#include "skein/topic_qos.hpp"

namespace skein {

/// Counters since the publisher was made.
struct PublisherCounters {
  /// Values and disposals.
  std::uint64_t published = 0;
  /// Periods in which an instance had no value; see TopicQos::deadline.
  std::uint64_t missed_deadlines = 0;
};

/// Publishes values of an IDL struct or union on a topic; made by Entity::publisher(). Thread-safe
/// and movable. A publisher that was moved from throws InvalidArgument. Destroy it before its
/// entity. See Subscription for both in use.
template <class T>
class [[nodiscard]] Publisher {
  static_assert(topics::kIsType<T>,
                "a topic carries values of an IDL struct or union; an interface is provided by "
                "Entity::provide() and called by Entity::connect()");

 public:
  /// Used by Entity::publisher().
  explicit Publisher(std::unique_ptr<topics::TopicWriter> writer) : writer_(std::move(writer)) {}

  /// Sends the value to all subscribers that are matched now, and keeps it for late joiners if the
  /// QoS say so. Throws Overloaded if reliable subscribers make no room within `max_blocking`,
  /// InvalidArgument for a value that CDR cannot carry. A value of more than 1 MiB that is
  /// published best effort is logged, the first time: it hardly arrives.
  void publish(const T& value) { topics::held(writer_).publish(&value); }

  /// Disposes the instance with this value's key. Throws as publish() does.
  void dispose(const T& value) requires Keyed<T> { topics::held(writer_).dispose(&value); }

  /// Waits until all reliable subscribers that are matched now have what was published. Returns
  /// false if they do not have it by the timeout. Call it before you destroy a publisher: values
  /// that subscribers have not received by then are lost.
  bool wait_for_acknowledgments(std::chrono::milliseconds timeout) {
    return topics::held(writer_).wait_for_acknowledgments(timeout);
  }

  /// Number of subscribers that are matched now.
  std::size_t subscribers() const { return topics::held(writer_).subscribers(); }

  PublisherCounters counters() const { return topics::held(writer_).counters(); }

 private:
  std::unique_ptr<topics::TopicWriter> writer_;
};

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

/// Receives the values of a topic; made by Entity::subscription(). With a callback, the executor
/// calls it for one value at a time, oldest first; without one, the user polls. Values wait in a
/// queue that the QoS bound (`history_depth` per key, `max_waiting` in all): a slow subscriber
/// loses its own oldest values, which are counted, and does not delay the publisher. A sample that
/// is no T is dropped and counted; the first is logged. The first exception from a callback is
/// logged; the next value follows. Keep it: its callbacks end with it.
///
/// Thread-safe, movable: one that was moved from throws InvalidArgument. The destructor waits for a
/// running callback; do not destroy it from one. Destroy it before its entity.
///
/// ```cpp
/// const auto chart = station.subscription<survey::Pose>(
///     "pose", skein::TopicQos::sensor(), [&](const survey::Pose& pose) { show(pose); });
///
/// auto poses = drone.publisher<survey::Pose>("pose", skein::TopicQos::sensor());
/// poses.publish({"drone", 12.0, -3.5});
/// ```
template <class T>
class [[nodiscard]] Subscription {
  static_assert(topics::kIsType<T>,
                "a topic carries values of an IDL struct or union; an interface is provided by "
                "Entity::provide() and called by Entity::connect()");

 public:
  using Callback = std::function<void(const T& value)>;

  /// Used by Entity::subscription().
  explicit Subscription(std::unique_ptr<topics::TopicReader> reader) : reader_(std::move(reader)) {}

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
  std::unique_ptr<topics::TopicReader> reader_;
};

}  // namespace skein
