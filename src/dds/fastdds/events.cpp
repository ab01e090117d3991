#include "events.hpp"

#include <pthread.h>

namespace skein::dds::fastdds {

EventThread::EventThread() : thread_([this] { run(); }) {
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

void EventThread::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [&] { return stopping_ || !events_.empty(); });
    if (stopping_) return;
    auto event = std::move(events_.front());
    events_.pop_front();
    lock.unlock();
    event();
    event = nullptr;
    lock.lock();
  }
}

EndpointEvents::EndpointEvents(EventThread& thread, Told on_matched, Told on_liveliness)
    : thread_(thread),
      on_matched_(std::move(on_matched)),
      on_liveliness_(std::move(on_liveliness)) {}

void EndpointEvents::matched(const Guid& peer, bool now) {
  {
    std::lock_guard lock(mutex_);
    const bool news = now ? peers_.insert(peer).second : peers_.erase(peer) > 0;
    silent_.erase(peer);
    if (!news) return;
  }
  tell(on_matched_, peer, now);
}

void EndpointEvents::alive(const Guid& peer, bool now) {
  {
    std::lock_guard lock(mutex_);
    if (!peers_.contains(peer)) return;
    // A newly matched writer is reported as alive too; only a return is news.
    if (now ? silent_.erase(peer) == 0 : !silent_.insert(peer).second) return;
  }
  tell(on_liveliness_, peer, now);
}

void EndpointEvents::tell(const Told& listener, const Guid& peer, bool now) {
  if (!listener) return;
  thread_.post([self = shared_from_this(), &listener, peer, now] {
    std::lock_guard telling(self->telling_);
    if (!self->closed_) listener(peer, now);
  });
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
