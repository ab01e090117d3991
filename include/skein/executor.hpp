#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "skein/detail/action.hpp"

namespace skein {

/// Scheduling of a thread. The defaults change nothing. If the system refuses a setting, a warning
/// is logged and the thread runs without it.
struct ThreadSettings {
  enum class Scheduling {
    Normal,      ///< The system's default; see `nice`.
    Fifo,        ///< SCHED_FIFO: before all normal threads, until it blocks.
    RoundRobin,  ///< SCHED_RR: as Fifo, in turn with threads of equal priority.
  };

  Scheduling scheduling = Scheduling::Normal;
  int priority = 0;              ///< With Fifo and RoundRobin: 1 (lowest) to 99.
  int nice = 0;                  ///< With Normal: -20 (most favoured) to 19.
  std::vector<unsigned> cpus{};  ///< CPUs on which it may run; empty: all.
  /// How long an idle thread polls for work before it sleeps. Polling saves a wake-up and costs CPU
  /// time.
  std::chrono::microseconds spin{0};
};

/// The thread on which the calls of a service or CSP run.
enum class CallThread {
  Own,     ///< The service's own. If one hangs, only its own callers wait, until their deadlines.
  Caller,  ///< A blocking call from the same process runs on its caller's thread. Saves a thread
           ///< switch; only for implementations whose calls end in bounded time by construction.
};

/// Runs tasks that must not run on the thread that submits them. A task must not throw.
class Executor {
 public:
  virtual ~Executor() = default;

  /// Queues the task. Returns false, and drops the task, if the queue is full or the executor has
  /// stopped. Callable from any thread; never blocks.
  virtual bool post(Action task) = 0;

  /// Queues the task even if the queue is full; if the executor has stopped, runs it at once on the
  /// calling thread. For tasks that must not be lost and are bounded elsewhere: the continuation of
  /// a call, which was admitted when it began.
  virtual void post_or_run(Action task) = 0;
};

class IdleWork;

/// A fixed number of named threads and one bounded queue, first in, first out. With one thread it
/// is a strand: no two tasks run at once.
class ThreadExecutor final : public Executor {
 public:
  /// How long its tasks take. If one of the Short ones takes a second, the log tells, with a `gdb`
  /// command, while there is a Process.
  enum class Tasks { Any, Short };

  /// `name` is the threads' name in a debugger (15 characters are kept). Throws InvalidArgument for
  /// settings that can never work; see ThreadSettings.
  explicit ThreadExecutor(std::string name, std::size_t threads = 1, std::size_t capacity = 4096,
                          const ThreadSettings& settings = {}, Tasks tasks = Tasks::Any);
  ThreadExecutor(std::string name, Tasks tasks);
  /// Waits for running tasks; drops the others.
  ~ThreadExecutor() override;

  bool post(Action task) override;
  void post_or_run(Action task) override;

  /// Work for its thread while there is no task; it begins after the next one. Only where there is
  /// one thread, and once.
  void work_while_idle(std::shared_ptr<IdleWork> work);

  /// Drops the tasks that have not begun and takes no more; does not wait. Calling it twice is no
  /// error.
  void request_stop();

  /// Waits for running tasks, drops the others, and ends the threads. Calling it twice is no error.
  /// Do not call it, or destroy the executor, from one of its own tasks.
  void stop();

  /// As stop(), but first runs all queued tasks, and those that they post.
  void finish();

  /// As stop(), but waits at most `patience`. A thread that is still in a task then is abandoned:
  /// it is left running, and `what_it_uses` is kept for the rest of the process's life. Returns
  /// false if a thread was abandoned.
  bool stop_or_abandon(std::chrono::milliseconds patience,
                       std::shared_ptr<const void> what_it_uses = nullptr);

 private:
  struct State;
  bool enqueue(Action& task, std::size_t capacity);

  std::shared_ptr<State> state_;
};

/// An executor without a thread: tasks run on the threads that call run_all() or run_until(). For
/// tests, and for a program with a loop of its own: a subscription whose SubscriptionOptions name
/// it wakes no other thread on the way to that loop. Its queue is unbounded. Thread-safe.
class ManualExecutor final : public Executor {
 public:
  bool post(Action task) override;
  void post_or_run(Action task) override;

  /// Runs queued tasks, and those that they queue, until none is left; returns how many ran.
  std::size_t run_all();

  /// Runs tasks as they come until `done()`, which is asked after those that wait have run, here or
  /// on another thread; false if it was not done by `until`. What `done()` depends on changes in
  /// tasks alone: post an empty one to have it asked.
  bool run_until(std::chrono::steady_clock::time_point until, const std::function<bool()>& done);

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Action> tasks_;
  std::size_t ran_ = 0;  // tasks, ever
};

}  // namespace skein
