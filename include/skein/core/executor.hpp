#pragma once

#include <chrono>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "skein/core/action.hpp"
#include "skein/core/thread_settings.hpp"

namespace skein {

class Worker;

/// Runs tasks for those who may not run them on their own thread. Every queue is bounded.
class Executor {
 public:
  virtual ~Executor() = default;

  /// Takes the task over; false, and nothing happens, where the queue is full or the executor has
  /// stopped. Callable from any thread; never blocks.
  virtual bool post(Action task) = 0;

  /// Takes the task over even where the queue is full; where the executor has stopped, runs it at
  /// once on the calling thread. For what must not be lost and is bounded elsewhere: the
  /// continuation of a call, which was admitted when it began.
  virtual void post_or_run(Action task) = 0;

  /// Runs the task on the calling thread where that keeps the executor's promise about concurrency
  /// and no task is waiting; false, and nothing happens, otherwise. What the task throws it throws.
  virtual bool try_run_inline(const std::function<void()>& task) = 0;

  /// Whether the calling thread is running one of this executor's tasks.
  virtual bool runs_here() const noexcept = 0;
};

/// A fixed number of named threads and one bounded queue, first in, first out. With one thread it
/// is a strand: no two tasks at once, inline ones included.
class ThreadExecutor final : public Executor {
 public:
  /// `name` shows in the debugger (15 characters at most are kept). Throws InvalidArgument for
  /// settings that can never work; see ThreadSettings.
  explicit ThreadExecutor(std::string name, std::size_t threads = 1, std::size_t capacity = 4096,
                          const ThreadSettings& settings = {});
  /// Runs no task that has not begun; waits for those that have.
  ~ThreadExecutor() override;

  bool post(Action task) override;
  void post_or_run(Action task) override;
  bool try_run_inline(const std::function<void()>& task) override;
  bool runs_here() const noexcept override;

  /// The calling thread, if it is one of some ThreadExecutor and runs that one's task itself, not
  /// another executor's inline; else nullptr. Of use on this thread, while the task lasts.
  static Worker* worker() noexcept;

  /// Lets tasks that have begun end, drops the others, ends the threads. Twice is no error. Not to
  /// be called, nor the executor destroyed, from one of its own tasks.
  void stop();

  /// As stop(), but first runs what has been posted, and what that posts.
  void finish();

  /// As stop(), but waits no longer than `patience`: a thread that is stuck in a task then is left
  /// to itself for the rest of the process's life, with `what_it_uses`, and so is each that was
  /// written off (Worker). False where one had to be left now.
  bool stop_or_abandon(std::chrono::milliseconds patience,
                       std::shared_ptr<const void> what_it_uses = nullptr);

 private:
  struct State;
  void request_stop();
  bool enqueue(Action& task, std::size_t capacity);

  std::shared_ptr<State> state_;
};

/// An executor without a thread, for tests: tasks run when the owner says so.
class ManualExecutor final : public Executor {
 public:
  bool post(Action task) override;
  void post_or_run(Action task) override;
  bool try_run_inline(const std::function<void()>&) override { return false; }
  bool runs_here() const noexcept override { return running_; }

  /// Runs what is queued, and what that queues, until nothing is left; returns how many ran.
  std::size_t run_all();

 private:
  std::mutex mutex_;
  std::deque<Action> tasks_;
  bool running_ = false;
};

}  // namespace skein
