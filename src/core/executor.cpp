#include "skein/executor.hpp"

#include <pthread.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <optional>
#include <thread>
#include <utility>

#include "core/threads/idle_work.hpp"
#include "core/threads/leave_behind.hpp"
#include "core/threads/stall_watch.hpp"
#include "core/threads/start_thread.hpp"
#include "core/threads/thread_settings.hpp"
#include "skein/clock.hpp"
#include "skein/detail/call_memory.hpp"

namespace skein {

void leave_behind(std::shared_ptr<const void> used) {
  static std::mutex mutex;
  static auto& left = *new std::vector<std::shared_ptr<const void>>;
  std::lock_guard lock(mutex);
  left.push_back(std::move(used));
}

// Shared with the threads, so that one of them can be left behind.
struct ThreadExecutor::State {
  State(std::string name_, std::size_t capacity_, const ThreadSettings& settings_, Tasks length_)
      : name(std::move(name_)), capacity(capacity_), settings(settings_), length(length_) {}

  const std::string name;
  const std::size_t capacity;
  const ThreadSettings settings;
  const Tasks length;
  std::mutex mutex;
  std::condition_variable changed;
  std::pmr::deque<Action> tasks{&call_memory()};
  std::vector<std::thread> threads;
  std::size_t alive = 0;  // threads that have not ended
  std::size_t running = 0;
  bool stopping = false;
  bool finishing = false;               // finish() waits until nothing is left to do
  std::atomic<bool> called{false};      // a task waits, or the end is near; for those who spin
  std::shared_ptr<IdleWork> idle_work;  // null: sleep
  std::thread::id idle_worker;          // who is in it

  // Under the lock, after each change of `tasks` or `stopping`.
  void note_change() { called = stopping || !tasks.empty(); }

  // Until the end is near, or there is a task.
  void await_task(std::unique_lock<std::mutex>& lock) {
    work_while_idle(lock);
    if (settings.spin.count() > 0 && !called.load(std::memory_order_acquire)) {
      lock.unlock();
      const auto end = saturating_sum(std::chrono::steady_clock::now(), settings.spin);
      // Yielding lets whoever shares the processor make the work that is waited for.
      while (!called.load(std::memory_order_acquire) && std::chrono::steady_clock::now() < end) {
        std::this_thread::yield();
      }
      lock.lock();
    }
    changed.wait(lock, [&] { return stopping || !tasks.empty(); });
  }

  void work_while_idle(std::unique_lock<std::mutex>& lock) {
    if (!idle_work || stopping || !tasks.empty()) return;
    idle_worker = std::this_thread::get_id();
    lock.unlock();
    idle_work->work_until([this] { return called.load(); });
    lock.lock();
    idle_worker = {};
  }

  // Under the lock, for a task or the end. Who has made the task in the idle work itself looks at
  // it next.
  bool idle_worker_must_be_called() const {
    return idle_worker != std::thread::id() && idle_worker != std::this_thread::get_id();
  }

  // Under the lock.
  void note_stop() {
    stopping = true;
    note_change();
    changed.notify_all();
  }

  void work() {
    pthread_setname_np(pthread_self(), name.c_str());
    apply(settings, name);
    std::optional<WatchedThread> watched;
    if (length == Tasks::Short) watched.emplace(name);
    std::unique_lock lock(mutex);
    while (true) {
      await_task(lock);
      if (stopping) break;
      auto task = std::move(tasks.front());
      tasks.pop_front();
      note_change();
      ++running;
      lock.unlock();
      if (watched) watched->begin();
      task();
      task = nullptr;
      if (watched) watched->end();
      lock.lock();
      --running;
      if (finishing) changed.notify_all();
    }
    --alive;
    changed.notify_all();
  }
};

ThreadExecutor::ThreadExecutor(std::string name, std::size_t threads, std::size_t capacity,
                               const ThreadSettings& settings, Tasks tasks) {
  check(settings, name);
  name.resize(std::min<std::size_t>(name.size(), 15));
  state_ = std::make_shared<State>(std::move(name), capacity, settings, tasks);
  try {
    std::lock_guard lock(state_->mutex);
    for (std::size_t i = 0; i < std::max<std::size_t>(threads, 1); ++i) {
      state_->threads.push_back(start_thread(state_->name, [state = state_] { state->work(); }));
      ++state_->alive;
    }
  } catch (...) {  // the system gives no other thread
    stop();
    throw;
  }
}

ThreadExecutor::ThreadExecutor(std::string name, Tasks tasks)
    : ThreadExecutor(std::move(name), 1, 4096, {}, tasks) {}

ThreadExecutor::~ThreadExecutor() { stop(); }

void ThreadExecutor::work_while_idle(std::shared_ptr<IdleWork> work) {
  std::lock_guard lock(state_->mutex);
  state_->idle_work = std::move(work);
}

void ThreadExecutor::request_stop() {
  std::pmr::deque<Action> dropped{
      &call_memory()};  // destroyed outside the lock: it may own what posts here
  bool call = false;
  {
    std::lock_guard lock(state_->mutex);
    dropped.swap(state_->tasks);
    state_->note_stop();
    call = state_->idle_worker_must_be_called();
  }
  if (call) state_->idle_work->wake();
}

void ThreadExecutor::stop() {
  request_stop();
  for (std::thread& thread : std::exchange(state_->threads, {})) thread.join();
}

bool ThreadExecutor::stop_or_abandon(std::chrono::milliseconds patience,
                                     std::shared_ptr<const void> what_it_uses) {
  request_stop();
  {
    std::unique_lock lock(state_->mutex);
    const auto end = saturating_sum(std::chrono::steady_clock::now(), patience);
    if (state_->changed.wait_until(lock, end, [&] { return state_->alive == 0; })) {
      lock.unlock();
      stop();
      return true;
    }
  }
  leave_behind(state_);
  leave_behind(std::move(what_it_uses));
  for (std::thread& thread : std::exchange(state_->threads, {})) thread.detach();
  return false;
}

void ThreadExecutor::finish() {
  {
    std::unique_lock lock(state_->mutex);
    state_->finishing = true;
    state_->changed.wait(lock, [&] { return state_->tasks.empty() && state_->running == 0; });
    state_->note_stop();
  }
  stop();
}

bool ThreadExecutor::post(Action task) { return enqueue(task, state_->capacity); }

void ThreadExecutor::post_or_run(Action task) {
  if (!enqueue(task, SIZE_MAX)) task();
}

// Leaves the task alone where it is not taken.
bool ThreadExecutor::enqueue(Action& task, std::size_t capacity) {
  bool call = false;
  {
    std::lock_guard lock(state_->mutex);
    if (state_->stopping || state_->tasks.size() >= capacity) return false;
    state_->tasks.push_back(std::move(task));
    state_->note_change();
    // Whoever ends next looks at the queue.
    if (state_->running == state_->alive) return true;
    call = state_->idle_worker_must_be_called();
    if (state_->finishing) state_->changed.notify_all();  // finish() waits there, too
  }
  if (call) {
    state_->idle_work->wake();
  } else {
    state_->changed.notify_one();
  }
  return true;
}

bool ManualExecutor::post(Action task) {
  std::lock_guard lock(mutex_);
  tasks_.push_back(std::move(task));
  changed_.notify_all();  // under the lock: whoever sees the task may end the executor
  return true;
}

void ManualExecutor::post_or_run(Action task) { post(std::move(task)); }

std::size_t ManualExecutor::run_all() {
  std::size_t count = 0;
  std::unique_lock lock(mutex_);
  while (!tasks_.empty()) {
    auto task = std::move(tasks_.front());
    tasks_.pop_front();
    lock.unlock();
    task();
    lock.lock();
    ++count;
  }
  if (count == 0) return 0;
  ran_ += count;
  changed_.notify_all();
  return count;
}

bool ManualExecutor::run_until(std::chrono::steady_clock::time_point until,
                               const std::function<bool()>& done) {
  std::unique_lock lock(mutex_);
  for (;;) {
    std::deque<Action> waiting;  // not those that they queue, which may never end
    waiting.swap(tasks_);
    lock.unlock();
    for (Action& task : waiting) task();
    lock.lock();
    ran_ += waiting.size();
    if (!waiting.empty()) changed_.notify_all();
    const std::size_t ran = ran_;
    lock.unlock();
    if (done()) return true;
    lock.lock();
    if (std::chrono::steady_clock::now() >= until) return false;
    changed_.wait_until(lock, until, [&] { return !tasks_.empty() || ran_ != ran; });
  }
}

}  // namespace skein
