#include "skein/clock.hpp"

#include <pthread.h>

#include <algorithm>
#include <thread>
#include <unordered_map>

#include "core/threads/stall_watch.hpp"
#include "core/threads/start_thread.hpp"
#include "skein/detail/call_memory.hpp"

namespace skein {

struct SystemClock::State {
  std::mutex mutex;
  std::condition_variable changed;   // a timer is due before the thread wakes, or the end has come
  std::condition_variable finished;  // the running action has returned
  // A queued call within the process has a timer of its own.
  std::pmr::map<std::pair<Instant, TimerId>, Action> timers{&call_memory()};
  std::pmr::unordered_map<TimerId, Instant> instants{&call_memory()};
  TimerId last = 0;
  TimerId running = 0;
  // When the thread looks at the timers at the latest. Most are cancelled, and followed by one that
  // is due later: it sleeps on, and looks once.
  Instant wakes = Instant::max();
  bool stopping = false;
  std::thread thread;

  void run() {
    pthread_setname_np(pthread_self(), "skein-timer");
    WatchedThread watched("skein-timer");
    std::unique_lock lock(mutex);
    while (!stopping) {
      const Instant now = std::chrono::steady_clock::now();
      const Instant due = timers.empty() ? Instant::max() : timers.begin()->first.first;
      if (due <= now) {
        run_first(lock, watched);
        continue;
      }
      if (due < wakes || wakes <= now) wakes = due;
      if (wakes == Instant::max()) {
        changed.wait(lock);
      } else {
        changed.wait_until(lock, wakes);
      }
    }
  }

  void run_first(std::unique_lock<std::mutex>& lock, WatchedThread& watched) {
    auto node = timers.extract(timers.begin());
    running = node.key().second;
    instants.erase(running);
    lock.unlock();
    watched.begin();
    node.mapped()();
    node.mapped() = nullptr;
    watched.end();
    lock.lock();
    running = 0;
    finished.notify_all();
  }
};

SystemClock::SystemClock() : state_(std::make_shared<State>()) {
  state_->thread = start_thread("skein-timer", [state = state_] { state->run(); });
}

SystemClock::~SystemClock() {
  {
    std::lock_guard lock(state_->mutex);
    state_->stopping = true;
  }
  state_->changed.notify_all();
  if (state_->thread.get_id() == std::this_thread::get_id()) {
    state_->thread.detach();  // a timer's action was the last to let go of the clock
  } else {
    state_->thread.join();
  }
}

TimerId SystemClock::call_at(Instant when, Action action) {
  std::lock_guard lock(state_->mutex);
  const TimerId id = ++state_->last;
  state_->timers.emplace(std::pair(when, id), std::move(action));
  state_->instants.emplace(id, when);
  if (when < state_->wakes) {
    state_->wakes = when;
    state_->changed.notify_one();
  }
  return id;
}

void SystemClock::cancel(TimerId timer) {
  Action dropped;  // destroyed outside the lock: it may own what calls back here
  std::unique_lock lock(state_->mutex);
  if (const auto found = state_->instants.find(timer); found != state_->instants.end()) {
    const auto position = state_->timers.find({found->second, timer});
    dropped = std::move(position->second);
    state_->timers.erase(position);
    state_->instants.erase(found);
    lock.unlock();
    return;
  }
  if (timer == 0 || state_->thread.get_id() == std::this_thread::get_id()) return;
  state_->finished.wait(lock, [&] { return state_->running != timer; });
}

Instant ManualClock::now() const {
  std::lock_guard lock(mutex_);
  return now_;
}

TimerId ManualClock::call_at(Instant when, Action action) {
  std::lock_guard lock(mutex_);
  timers_.emplace(std::pair(when, ++last_), std::move(action));
  return last_;
}

void ManualClock::cancel(TimerId timer) {
  Action dropped;  // destroyed outside the lock: it may own what calls back here
  std::unique_lock lock(mutex_);
  const auto found = std::find_if(timers_.begin(), timers_.end(),
                                  [&](const auto& entry) { return entry.first.second == timer; });
  if (found != timers_.end()) {
    dropped = std::move(found->second);
    timers_.erase(found);
    return;
  }
  finished_.wait(lock, [&] {
    const auto running = running_.find(timer);
    return running == running_.end() || running->second == std::this_thread::get_id();
  });
}

void ManualClock::advance(Duration by) {
  std::unique_lock lock(mutex_);
  const Instant end = saturating_sum(now_, by);
  while (!timers_.empty() && timers_.begin()->first.first <= end) {
    auto node = timers_.extract(timers_.begin());
    const TimerId timer = node.key().second;
    now_ = std::max(now_, node.key().first);
    running_.emplace(timer, std::this_thread::get_id());
    lock.unlock();
    node.mapped()();
    node.mapped() = nullptr;
    lock.lock();
    running_.erase(timer);
    finished_.notify_all();
  }
  now_ = end;
}

}  // namespace skein
