#include "skein/core/executor.hpp"

#include <pthread.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <utility>

namespace skein {
namespace {

// Executors nest when a task of one runs another's task inline, so the innermost alone is not enough.
thread_local std::vector<const Executor*> entered;

class Entered {
 public:
  explicit Entered(const Executor* executor) { entered.push_back(executor); }
  ~Entered() { entered.pop_back(); }
  Entered(const Entered&) = delete;
  Entered& operator=(const Entered&) = delete;
};

}  // namespace

// Shared with the threads, so that one of them can be left behind.
struct ThreadExecutor::State {
  State(const ThreadExecutor* executor, std::size_t capacity, std::size_t concurrency,
        const ThreadSettings& settings)
      : identity(executor), capacity(capacity), concurrency(concurrency), settings(settings) {}

  const Executor* const identity;  // compared, never followed
  const std::size_t capacity;
  const std::size_t concurrency;
  const ThreadSettings settings;
  std::mutex mutex;
  std::condition_variable changed;
  std::deque<std::function<void()>> tasks;
  std::size_t running = 0;
  std::size_t threads = 0;
  bool stopping = false;
  bool finishing = false;  // finish() waits until nothing is left to do
  std::atomic<bool> called{false};  // a task waits, or the end is near: what a spinning thread looks at

  // Under the lock, after each change of `tasks` or `stopping`.
  void note_change() { called.store(stopping || !tasks.empty(), std::memory_order_release); }

  void await_task(std::unique_lock<std::mutex>& lock) {
    const auto ready = [&] { return stopping || (!tasks.empty() && running < concurrency); };
    if (settings.spin.count() > 0 && !ready()) {
      lock.unlock();
      const auto end = std::chrono::steady_clock::now() + settings.spin;
      // Yielding lets whoever shares the processor make the work that is waited for.
      while (!called.load(std::memory_order_acquire) && std::chrono::steady_clock::now() < end) {
        std::this_thread::yield();
      }
      lock.lock();
    }
    changed.wait(lock, ready);
  }

  void work(const std::string& name) {
    pthread_setname_np(pthread_self(), name.c_str());
    apply(settings, name);
    const Entered here(identity);
    std::unique_lock lock(mutex);
    while (true) {
      await_task(lock);
      if (stopping) break;
      auto task = std::move(tasks.front());
      tasks.pop_front();
      note_change();
      ++running;
      lock.unlock();
      task();
      task = nullptr;
      lock.lock();
      --running;
      if (finishing) changed.notify_all();
    }
    --threads;
    changed.notify_all();
  }

  bool idle() const { return threads == 0 && running == 0; }
};

ThreadExecutor::ThreadExecutor(std::string name, std::size_t threads, std::size_t capacity,
                               const ThreadSettings& settings)
    : state_(std::make_shared<State>(this, capacity, std::max<std::size_t>(threads, 1), settings)) {
  check(settings, name);
  name.resize(std::min<std::size_t>(name.size(), 15));
  state_->threads = state_->concurrency;
  for (std::size_t i = 0; i < state_->concurrency; ++i) {
    threads_.emplace_back([state = state_, name] { state->work(name); });
  }
}

ThreadExecutor::~ThreadExecutor() { stop(); }

void ThreadExecutor::request_stop() {
  std::deque<std::function<void()>> dropped;  // destroyed outside the lock: it may own what posts here
  std::lock_guard lock(state_->mutex);
  state_->stopping = true;
  dropped.swap(state_->tasks);
  state_->note_change();
  state_->changed.notify_all();
}

void ThreadExecutor::stop() {
  request_stop();
  for (std::thread& thread : threads_) thread.join();
  threads_.clear();
  std::unique_lock lock(state_->mutex);
  state_->changed.wait(lock, [&] { return state_->running == 0; });
}

bool ThreadExecutor::stop_or_abandon(std::chrono::milliseconds patience) {
  request_stop();
  std::unique_lock lock(state_->mutex);
  const bool ended = state_->changed.wait_for(lock, patience, [&] { return state_->idle(); });
  lock.unlock();
  for (std::thread& thread : threads_) {
    if (ended) {
      thread.join();
    } else {
      thread.detach();
    }
  }
  threads_.clear();
  return ended;
}

void ThreadExecutor::finish() {
  {
    std::unique_lock lock(state_->mutex);
    state_->finishing = true;
    state_->changed.wait(lock, [&] { return state_->tasks.empty() && state_->running == 0; });
    state_->stopping = true;
    state_->note_change();
    state_->changed.notify_all();
  }
  stop();
}

bool ThreadExecutor::post(std::function<void()> task) { return enqueue(task, state_->capacity); }

void ThreadExecutor::post_or_run(std::function<void()> task) {
  if (!enqueue(task, SIZE_MAX)) task();
}

// Leaves the task alone where it is not taken.
bool ThreadExecutor::enqueue(std::function<void()>& task, std::size_t capacity) {
  {
    std::lock_guard lock(state_->mutex);
    if (state_->stopping || state_->tasks.size() >= capacity) return false;
    state_->tasks.push_back(std::move(task));
    state_->note_change();
    if (state_->running == state_->concurrency) return true;  // whoever ends next looks at the queue
  }
  state_->changed.notify_one();
  return true;
}

bool ThreadExecutor::try_run_inline(const std::function<void()>& task) {
  const auto state = state_;
  {
    std::lock_guard lock(state->mutex);
    if (state->stopping || !state->tasks.empty() || state->running == state->concurrency) return false;
    ++state->running;
  }
  struct Leave {
    State& state;
    ~Leave() {
      bool wake;
      {
        std::lock_guard lock(state.mutex);
        --state.running;
        wake = state.stopping || state.finishing || !state.tasks.empty();
      }
      if (wake) state.changed.notify_all();
    }
  } leave{*state};
  const Entered here(this);
  task();
  return true;
}

bool ThreadExecutor::runs_here() const noexcept {
  return std::find(entered.begin(), entered.end(), this) != entered.end();
}

bool ManualExecutor::post(std::function<void()> task) {
  std::lock_guard lock(mutex_);
  tasks_.push_back(std::move(task));
  return true;
}

void ManualExecutor::post_or_run(std::function<void()> task) { post(std::move(task)); }

std::size_t ManualExecutor::run_all() {
  std::size_t count = 0;
  std::unique_lock lock(mutex_);
  while (!tasks_.empty()) {
    auto task = std::move(tasks_.front());
    tasks_.pop_front();
    running_ = true;
    lock.unlock();
    task();
    lock.lock();
    running_ = false;
    ++count;
  }
  return count;
}

}  // namespace skein
