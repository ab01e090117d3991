#pragma once

#include <chrono>
#include <functional>
#include <mutex>
#include <utility>
#include <vector>

#include "rpc/service/introspection_topic.hpp"
#include "skein/clock.hpp"

namespace skein::introspection {

/// Publishes the values of a source on one of the topics about an entity, at each of its intervals,
/// and only while a reader is there.
template <class T>
class PeriodicTopic {
 public:
  /// `anew`: the first time since a further reader has come.
  using Source = std::function<std::vector<T>(bool anew)>;

  /// `participant`, `clock` and `control`, on which `source` is asked, outlive the topic.
  PeriodicTopic(dds::Participant& participant, Clock& clock, Executor& control,
                const Topic<T>& topic, Source source)
      : clock_(clock),
        interval_(topic.interval),
        source_(std::move(source)),
        publisher_(participant, control, topic) {
    publisher_.when_read([this] { begin(); });
  }

  /// `source` is not being asked any more when it returns. Not from a task of `control`.
  ~PeriodicTopic() {
    TimerId timer;
    {
      std::lock_guard lock(mutex_);
      closed_ = true;
      timer = timer_;
    }
    clock_.cancel(timer);
  }

 private:
  void begin() {
    {
      std::lock_guard lock(mutex_);
      anew_ = true;
      if (std::exchange(ticking_, true)) return;  // an earlier reader's timer is set
    }
    tick();
  }

  void tick() {
    bool anew;
    {
      std::lock_guard lock(mutex_);
      anew = std::exchange(anew_, false);
      ticking_ = publisher_.on() && !closed_;
      if (!ticking_) return;
      timer_ = clock_.call_after(interval_, [this] { publisher_.post([this] { tick(); }); });
    }
    for (T& value : source_(anew)) publisher_.publish(std::move(value));
  }

  Clock& clock_;
  const std::chrono::milliseconds interval_;
  const Source source_;
  std::mutex mutex_;
  bool ticking_ = false;
  bool anew_ = false;
  bool closed_ = false;
  TimerId timer_ = 0;
  Publisher<T> publisher_;  // last: goes first, and waits for a tick that runs
};

}  // namespace skein::introspection
