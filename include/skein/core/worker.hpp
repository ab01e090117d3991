#pragma once

#include <atomic>
#include <functional>

namespace skein {

/// A thread of a ThreadExecutor, for work on it that may never return. Such work stands between
/// expose() and cover(). Whoever sees that it hangs writes the worker off: the executor goes on
/// with a spare thread, and this one is parked for the rest of the process's life should the work
/// return after all: nothing of what called it runs on beside the spare.
class Worker {
 public:
  /// Made by the executor whose thread it is; `replace` makes the spare.
  explicit Worker(std::function<void()> replace) : replace_(std::move(replace)) {}

  /// On its own thread: work that may hang begins, and has ended. Neither returns once the worker
  /// is written off or its executor has been abandoned.
  void expose() noexcept { pass(Standing::Covered, Standing::Exposed); }
  void cover() noexcept { pass(Standing::Exposed, Standing::Covered); }

  /// On another thread: replaces the worker; false, and nothing happens, where it is not exposed.
  bool write_off();

  /// Parks the thread when it next passes expose() or cover(); there will be no spare.
  void abandon() noexcept { standing_ = Standing::WrittenOff; }

 private:
  enum class Standing { Covered, Exposed, WrittenOff };
  void pass(Standing from, Standing to) noexcept {
    if (!standing_.compare_exchange_strong(from, to)) park();
  }
  [[noreturn]] static void park() noexcept;

  const std::function<void()> replace_;
  std::atomic<Standing> standing_{Standing::Covered};
};

}  // namespace skein
