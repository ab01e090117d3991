#include "skein/core/executor.hpp"

#include <pthread.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <utility>

#include "skein/core/call_memory.hpp"

namespace skein {
namespace {

// Executors nest when a task of one runs another's task inline, so the innermost alone is not
// enough.
thread_local std::vector<const Executor*> entered;

class Entered {
 public:
  explicit Entered(const Executor* executor) { entered.push_back(executor); }
  ~Entered() { entered.pop_back(); }
  Entered(const Entered&) = delete;
  Entered& operator=(const Entered&) = delete;
};

// What a task that never ended may still use: for the rest of the process's life.
void leave_behind(std::shared_ptr<void> state) {
  static std::mutex mutex;
  static auto& left = *new std::vector<std::shared_ptr<void>>;
  std::lock_guard lock(mutex);
  left.push_back(std::move(state));
}

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
  std::pmr::deque<Action> tasks{&call_memory()};
  std::size_t threads = 0;
  bool stopping = false;
  bool finishing = false;  // finish() waits until nothing is left to do

  // How many tasks run, and whether a task waits or the end is near: in one word, so that a task
  // which runs inline takes no lock. kCalled changes under the lock alone.
  static constexpr std::size_t kCalled = 1;
  static constexpr std::size_t kOne = 2;
  std::atomic<std::size_t> state{0};

  std::size_t running() const { return state.load() / kOne; }
  bool called() const { return (state.load(std::memory_order_acquire) & kCalled) != 0; }

  // Under the lock, after each change of `tasks`, `stopping` or `finishing`.
  void note_change() {
    if (stopping || finishing || !tasks.empty()) {
      state.fetch_or(kCalled);
    } else {
      state.fetch_and(~kCalled);
    }
  }

  bool try_begin(bool unless_called) {
    std::size_t seen = state.load(std::memory_order_relaxed);
    do {
      if (seen / kOne == concurrency || (unless_called && (seen & kCalled))) return false;
    } while (!state.compare_exchange_weak(seen, seen + kOne));
    return true;
  }

  // Who waits for room, or for the end, has set kCalled before; after that all is done under the
  // lock, since who waits for the end then takes everything away.
  void end_inline() {
    std::size_t seen = state.load(std::memory_order_relaxed);
    while (!(seen & kCalled)) {
      if (state.compare_exchange_weak(seen, seen - kOne)) return;
    }
    std::lock_guard lock(mutex);
    state.fetch_sub(kOne);
    changed.notify_all();
  }

  // Until the end is near, or there is a task, which then counts as running.
  void await_task(std::unique_lock<std::mutex>& lock) {
    if (settings.spin.count() > 0 && !called()) {
      lock.unlock();
      const auto end = std::chrono::steady_clock::now() + settings.spin;
      // Yielding lets whoever shares the processor make the work that is waited for.
      while (!called() && std::chrono::steady_clock::now() < end) {
        std::this_thread::yield();
      }
      lock.lock();
    }
    changed.wait(lock, [&] { return stopping || (!tasks.empty() && try_begin(false)); });
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
      lock.unlock();
      task();
      task = nullptr;
      lock.lock();
      state.fetch_sub(kOne);
      if (finishing) changed.notify_all();
    }
    --threads;
    changed.notify_all();
  }

  bool idle() const { return threads == 0 && running() == 0; }
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
  std::pmr::deque<Action> dropped{
      &call_memory()};  // destroyed outside the lock: it may own what posts here
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
  state_->changed.wait(lock, [&] { return state_->running() == 0; });
}

bool ThreadExecutor::stop_or_abandon(std::chrono::milliseconds patience) {
  request_stop();
  std::unique_lock lock(state_->mutex);
  const bool ended = state_->changed.wait_for(lock, patience, [&] { return state_->idle(); });
  lock.unlock();
  if (!ended) leave_behind(state_);
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
    state_->note_change();
    state_->changed.wait(lock, [&] { return state_->tasks.empty() && state_->running() == 0; });
    state_->stopping = true;
    state_->note_change();
    state_->changed.notify_all();
  }
  stop();
}

bool ThreadExecutor::post(Action task) { return enqueue(task, state_->capacity); }

void ThreadExecutor::post_or_run(Action task) {
  if (!enqueue(task, SIZE_MAX)) task();
}

// Leaves the task alone where it is not taken.
bool ThreadExecutor::enqueue(Action& task, std::size_t capacity) {
  {
    std::lock_guard lock(state_->mutex);
    if (state_->stopping || state_->tasks.size() >= capacity) return false;
    state_->tasks.push_back(std::move(task));
    state_->note_change();
    if (state_->running() == state_->concurrency)
      return true;  // whoever ends next looks at the queue
  }
  state_->changed.notify_one();
  return true;
}

bool ThreadExecutor::try_run_inline(const std::function<void()>& task) {
  State& state = *state_;
  if (!state.try_begin(true)) return false;
  struct End {
    State& state;
    ~End() { state.end_inline(); }
  } end{state};
  const Entered here(this);
  task();
  return true;
}

bool ThreadExecutor::runs_here() const noexcept {
  return std::find(entered.begin(), entered.end(), this) != entered.end();
}

bool ManualExecutor::post(Action task) {
  std::lock_guard lock(mutex_);
  tasks_.push_back(std::move(task));
  return true;
}

void ManualExecutor::post_or_run(Action task) { post(std::move(task)); }

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
