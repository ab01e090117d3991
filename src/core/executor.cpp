#include "skein/core/executor.hpp"

#include <pthread.h>

#include <algorithm>
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

ThreadExecutor::ThreadExecutor(std::string name, std::size_t threads, std::size_t capacity)
    : capacity_(capacity), concurrency_(std::max<std::size_t>(threads, 1)) {
  name.resize(std::min<std::size_t>(name.size(), 15));
  for (std::size_t i = 0; i < concurrency_; ++i) {
    threads_.emplace_back([this, name] { work(name); });
  }
}

ThreadExecutor::~ThreadExecutor() { stop(); }

void ThreadExecutor::stop() {
  std::deque<std::function<void()>> dropped;
  std::vector<std::thread> threads;
  {
    std::lock_guard lock(mutex_);
    stopping_ = true;
    dropped.swap(tasks_);
    threads.swap(threads_);
  }
  changed_.notify_all();
  for (std::thread& thread : threads) thread.join();
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return running_ == 0; });
}

bool ThreadExecutor::post(std::function<void()> task) {
  {
    std::lock_guard lock(mutex_);
    if (stopping_ || tasks_.size() >= capacity_) return false;
    tasks_.push_back(std::move(task));
    if (running_ == concurrency_) return true;  // whoever ends next looks at the queue
  }
  changed_.notify_one();
  return true;
}

bool ThreadExecutor::try_run_inline(const std::function<void()>& task) {
  {
    std::lock_guard lock(mutex_);
    if (stopping_ || !tasks_.empty() || running_ == concurrency_) return false;
    ++running_;
  }
  struct Leave {
    ThreadExecutor& executor;
    ~Leave() {
      bool wake;
      {
        std::lock_guard lock(executor.mutex_);
        --executor.running_;
        wake = executor.stopping_ || !executor.tasks_.empty();
      }
      if (wake) executor.changed_.notify_all();
    }
  } leave{*this};
  const Entered here(this);
  task();
  return true;
}

bool ThreadExecutor::runs_here() const noexcept {
  return std::find(entered.begin(), entered.end(), this) != entered.end();
}

void ThreadExecutor::work(const std::string& name) {
  pthread_setname_np(pthread_self(), name.c_str());
  const Entered here(this);
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock,
                  [&] { return stopping_ || (!tasks_.empty() && running_ < concurrency_); });
    if (stopping_) return;
    auto task = std::move(tasks_.front());
    tasks_.pop_front();
    ++running_;
    lock.unlock();
    task();
    task = nullptr;
    lock.lock();
    --running_;
    if (stopping_) changed_.notify_all();
  }
}

bool ManualExecutor::post(std::function<void()> task) {
  std::lock_guard lock(mutex_);
  tasks_.push_back(std::move(task));
  return true;
}

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
