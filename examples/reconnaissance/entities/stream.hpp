#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <vector>

#include "clock/ticks.hpp"
#include "skein/entity.hpp"
#include "skein/executor.hpp"
#include "topics.hpp"

namespace reconnaissance {

/// The QoS of streams of the simulated world: best effort, and no lifespan or deadline, which DDS
/// counts by the system's clock, where a mission may be paused or ten times as fast. Who reads a
/// stream looks at the ticks of its samples instead.
inline skein::TopicQos stream_qos() {
  skein::TopicQos qos = skein::TopicQos::sensor();
  qos.lifespan.reset();
  return qos;
}

/// To read every value of a state, though the reader is late by some.
inline skein::TopicQos all_of_state() {
  skein::TopicQos qos = skein::TopicQos::state();
  qos.history_depth = 64;
  return qos;
}

/// As Skein publishes decisions: outside of any system.
inline skein::TopicQos decisions_qos() {
  skein::TopicQos qos = stream_qos();
  qos.history_depth = 64;
  qos.systems = {""};
  return qos;
}

/// Reads a topic whose samples bear the tick to which they belong. Thread-safe.
template <class T>
class Stream {
 public:
  /// Longer than a sample that has been sent takes on a busy machine, through all who make it of
  /// others' samples of the same tick.
  static constexpr skein::Duration kPatience = std::chrono::seconds(1);

  Stream(skein::Entity& entity, const StreamTopic& topic, const skein::TopicQos& qos = stream_qos())
      : period_(topic.period),
        subscription_(entity.subscription<T>(topic.name, for_reading(qos),
                                             [this](const T& sample) { keep(sample); },
                                             {.executor = &reading_})) {}

  /// The sample of that tick, or of the last before at which there is one. Waits for it while
  /// somebody publishes, `patience` at most and once; then it is counted as lost, and the newest
  /// from before stands in for it, if there is any.
  std::optional<T> at(Tick tick, skein::Duration patience = kPatience) {
    if (tick < 0) return std::nullopt;
    read();
    const Tick wanted = tick - tick % period_;
    if (is_to_come(wanted)) await(wanted, patience);
    std::lock_guard lock(mutex_);
    for (auto sample = samples_.rbegin(); sample != samples_.rend(); ++sample)
      if (sample->tick <= tick) return *sample;
    return std::nullopt;
  }

  /// All up to that tick that were not taken before, in order; waits for that of the tick as at()
  /// does. For topics whose samples each say something of their own: published reliably, and taken
  /// before 16 more have come.
  std::vector<T> take(Tick tick) {
    at(tick);
    std::lock_guard lock(mutex_);
    std::vector<T> taken;
    for (const T& sample : samples_)
      if (sample.tick > taken_ && sample.tick <= tick) taken.push_back(sample);
    if (!taken.empty()) taken_ = taken.back().tick;
    return taken;
  }

  /// The newest that has arrived.
  std::optional<T> latest() {
    read();
    std::lock_guard lock(mutex_);
    return samples_.empty() ? std::nullopt : std::optional(samples_.back());
  }

  /// Samples that did not arrive when they were needed.
  std::uint64_t lost() const {
    std::lock_guard lock(mutex_);
    return lost_;
  }

 private:
  // Those of a second where there are ten, and of who is a little ahead.
  static constexpr std::uint32_t kKept = 16;

  /// Samples wait in the subscription until somebody reads here.
  static skein::TopicQos for_reading(skein::TopicQos qos) {
    if (qos.history_depth) qos.history_depth = std::max(*qos.history_depth, kKept);
    return qos;
  }

  void read() {
    reading_.run_until({}, [] { return true; });
  }

  void keep(const T& sample) {
    std::lock_guard lock(mutex_);
    samples_.push_back(sample);
    if (samples_.size() > kKept) samples_.pop_front();
  }

  bool is_to_come(Tick wanted) const {
    std::lock_guard lock(mutex_);
    return (samples_.empty() || samples_.back().tick < wanted) && wanted > in_vain_;
  }

  void await(Tick wanted, skein::Duration patience) {
    const bool hopeless = subscription_.publishers() == 0;
    const auto until = std::chrono::steady_clock::now() + (hopeless ? skein::Duration{} : patience);
    if (reading_.run_until(until, [&] { return !is_to_come(wanted); })) return;
    std::lock_guard lock(mutex_);
    ++lost_;
    in_vain_ = wanted;
  }

  int period_;
  skein::ManualExecutor reading_;  // so that a sample wakes the thread that waits, and no other
  mutable std::mutex mutex_;
  std::deque<T> samples_;
  std::uint64_t lost_ = 0;
  Tick in_vain_ = -1;  // the last that was waited for and did not come
  Tick taken_ = -1;
  skein::Subscription<T> subscription_;
};

}  // namespace reconnaissance
