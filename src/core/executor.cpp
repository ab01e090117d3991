#include "skein/core/executor.hpp"

#include <pthread.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <map>
#include <system_error>
#include <utility>

#include "skein/core/call_memory.hpp"
#include "skein/core/log.hpp"
#include "skein/core/worker.hpp"

namespace skein {
namespace {

// Executors nest when a task of one runs another's task inline, so the innermost alone is not
// enough.
thread_local std::vector<const Executor*> entered;
thread_local Worker* own_worker = nullptr;

class Entered {
 public:
  explicit Entered(const Executor* executor) { entered.push_back(executor); }
  ~Entered() { entered.pop_back(); }
  Entered(const Entered&) = delete;
  Entered& operator=(const Entered&) = delete;
};

// What a task that never ended may still use: for the rest of the process's life.
void leave_behind(std::shared_ptr<const void> state) {
  static std::mutex mutex;
  static auto& left = *new std::vector<std::shared_ptr<const void>>;
  std::lock_guard lock(mutex);
  left.push_back(std::move(state));
}

}  // namespace

// Shared with the threads, so that one of them can be left behind.
struct ThreadExecutor::State : std::enable_shared_from_this<State> {
  State(const ThreadExecutor* executor, std::string name_, std::size_t capacity,
        std::size_t concurrency, const ThreadSettings& settings)
      : identity(executor),
        name(std::move(name_)),
        capacity(capacity),
        concurrency(concurrency),
        settings(settings) {}

  struct Hand {
    std::thread thread;
    std::shared_ptr<Worker> worker;
  };

  const Executor* const identity;  // compared, never followed
  const std::string name;
  const std::size_t capacity;
  const std::size_t concurrency;
  const ThreadSettings settings;
  std::mutex mutex;
  std::condition_variable changed;
  std::pmr::deque<Action> tasks{&call_memory()};
  std::map<std::uint64_t, Hand> hands;  // those that were written off are gone from here
  std::uint64_t last_hand = 0;
  std::size_t threads = 0;  // that have not ended
  bool stopping = false;
  bool abandoned = false;  // nobody waits for those that run
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

  // Under the lock.
  void add_thread() {
    const std::uint64_t number = ++last_hand;
    const auto worker = std::make_shared<Worker>([state = weak_from_this(), number] {
      if (const auto self = state.lock()) self->replace(number);
    });
    Hand& hand = hands[number] = {{}, worker};
    hand.thread = std::thread([state = shared_from_this(), worker] { state->work(*worker); });
    ++threads;
  }

  void replace(std::uint64_t number) {
    std::lock_guard lock(mutex);
    const auto lost = hands.find(number);
    if (lost == hands.end()) return;  // with the whole executor
    lost->second.thread.detach();
    hands.erase(lost);
    --threads;
    state.fetch_sub(kOne);
    try {
      if (!stopping) add_thread();
    } catch (const std::system_error& error) {
      hands.erase(last_hand);
      log(LogLevel::Error, name,
          std::string("has a thread less, as the system gives no other: ") + error.what());
    }
    changed.notify_all();
  }

  // Joins those that have ended; the others are left to themselves.
  void let_go(bool ended) {
    std::map<std::uint64_t, Hand> leaving;
    {
      std::lock_guard lock(mutex);
      leaving.swap(hands);
    }
    for (auto& [number, hand] : leaving) {
      if (ended) {
        hand.thread.join();
      } else {
        hand.worker->abandon();
        hand.thread.detach();
      }
    }
  }

  void work(Worker& worker) {
    pthread_setname_np(pthread_self(), name.c_str());
    apply(settings, name);
    own_worker = &worker;
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

  bool idle() const { return abandoned || (threads == 0 && running() == 0); }
};

ThreadExecutor::ThreadExecutor(std::string name, std::size_t threads, std::size_t capacity,
                               const ThreadSettings& settings) {
  check(settings, name);
  name.resize(std::min<std::size_t>(name.size(), 15));
  state_ = std::make_shared<State>(this, std::move(name), capacity,
                                   std::max<std::size_t>(threads, 1), settings);
  std::lock_guard lock(state_->mutex);
  for (std::size_t i = 0; i < state_->concurrency; ++i) state_->add_thread();
}

ThreadExecutor::~ThreadExecutor() { stop(); }

Worker* ThreadExecutor::worker() noexcept { return entered.size() == 1 ? own_worker : nullptr; }

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
  {
    std::unique_lock lock(state_->mutex);
    state_->changed.wait(lock, [&] { return state_->idle(); });
  }
  state_->let_go(true);
}

bool ThreadExecutor::stop_or_abandon(std::chrono::milliseconds patience,
                                     std::shared_ptr<const void> what_it_uses) {
  request_stop();
  std::unique_lock lock(state_->mutex);
  const bool ended = state_->changed.wait_for(lock, patience, [&] { return state_->idle(); });
  state_->abandoned = !ended;
  lock.unlock();
  if (!ended) {
    leave_behind(state_);
    leave_behind(std::move(what_it_uses));
  }
  state_->let_go(ended);
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
