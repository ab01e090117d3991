#pragma once

#include <functional>

namespace skein {

/// What the thread of an executor does while it has no task, in place of sleeping.
class IdleWork {
 public:
  virtual ~IdleWork() = default;
  /// On the executor's thread, until `over`, which wake() makes it look at. It may return earlier:
  /// the thread sleeps then until its next task.
  virtual void work_until(const std::function<bool()>& over) = 0;
  /// On any thread.
  virtual void wake() = 0;
};

}  // namespace skein
