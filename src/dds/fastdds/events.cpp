#include "events.hpp"

#include <pthread.h>

#include "core/threads/stall_watch.hpp"
#include "core/threads/start_thread.hpp"

namespace skein::dds::fastdds {

EventThread::EventThread(std::function<void()> tick)
    : tick_(std::move(tick)), thread_(start_thread("skein-dds-event", [this] { run(); })) {
  pthread_setname_np(thread_.native_handle(), "skein-dds-event");
}

EventThread::~EventThread() {
  {
    std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

void EventThread::post(std::function<void()> event) {
  {
    std::lock_guard lock(mutex_);
    events_.push_back(std::move(event));
  }
  changed_.notify_one();
}

void EventThread::tick_every(std::chrono::nanoseconds period) {
  {
    std::lock_guard lock(mutex_);
    if (period_ && *period_ <= period) return;
    period_ = period;
    last_tick_ = std::chrono::steady_clock::now();
  }
  changed_.notify_one();
}

std::chrono::steady_clock::time_point EventThread::next_tick() const {
  using Clock = std::chrono::steady_clock;
  return period_ ? last_tick_ + std::chrono::duration_cast<Clock::duration>(*period_)
                 : Clock::time_point::max();
}

void EventThread::run() {
  WatchedThread watched("skein-dds-event");
  std::unique_lock lock(mutex_);
  for (;;) {
    const auto next = next_tick();
    const auto due = [&] { return stopping_ || !events_.empty() || next_tick() < next; };
    if (period_) {
      changed_.wait_until(lock, next, due);
    } else {
      changed_.wait(lock, due);
    }
    if (stopping_) return;
    // In turn: on a busy machine a tick may be due again as soon as one ends, and the events too
    // must get on.
    if (const auto now = std::chrono::steady_clock::now(); now >= next_tick()) {
      last_tick_ = now;
      lock.unlock();
      watched.begin();
      tick_();
      watched.end();
      lock.lock();
    }
    if (stopping_ || events_.empty()) continue;
    auto event = std::move(events_.front());
    events_.pop_front();
    lock.unlock();
    watched.begin();
    event();
    event = nullptr;
    watched.end();
    lock.lock();
  }
}

EndpointEvents::EndpointEvents(EventThread& thread, EndpointListener listener)
    : thread_(thread), listener_(std::move(listener)) {}

template <class Function, class... Arguments>
void EndpointEvents::tell(const Function& function, const Arguments&... arguments) {
  if (!function) return;
  thread_.post([self = shared_from_this(), &function, arguments...] {
    std::lock_guard telling(self->telling_);
    if (!self->closed_) function(arguments...);
  });
}

void EndpointEvents::matched(const Guid& peer, bool now) {
  {
    std::lock_guard lock(mutex_);
    const bool news = now ? peers_.insert(peer).second : peers_.erase(peer) > 0;
    silent_.erase(peer);
    if (!news) return;
  }
  tell(listener_.on_matched, peer, now);
}

void EndpointEvents::alive(const Guid& peer, bool now) {
  {
    std::lock_guard lock(mutex_);
    if (!peers_.contains(peer)) return;
    // A newly matched writer is reported as alive too; only a return is news.
    if (now ? silent_.erase(peer) == 0 : !silent_.insert(peer).second) return;
  }
  tell(listener_.on_liveliness, peer, now);
}

void EndpointEvents::incompatible(const Incompatibility& why) {
  tell(listener_.on_incompatible, why);
}

std::vector<Guid> EndpointEvents::peers() const {
  std::lock_guard lock(mutex_);
  return {peers_.begin(), peers_.end()};
}

void EndpointEvents::close() {
  std::lock_guard telling(telling_);
  closed_ = true;
}

}  // namespace skein::dds::fastdds
