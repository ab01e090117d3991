#pragma once

#include <condition_variable>
#include <mutex>

#include "skein/clock.hpp"

namespace skein {

/// Waits, as std::condition_variable::wait_until does, until `predicate` holds or `clock` has
/// reached `deadline`; gives what `predicate` says then. Time is the clock's alone: with a
/// ManualClock nothing but a notification or its advance() wakes. `lock` is held when it is called,
/// while `predicate` runs, and when it returns or throws what `predicate` threw; it is let go of in
/// between. Not from an action of that clock, which would wait for itself.
template <class Predicate>
bool wait_until(Clock& clock, Instant deadline, std::unique_lock<std::mutex>& lock,
                std::condition_variable& changed, Predicate predicate) {
  // Its action takes the mutex, so that it is neither set nor cancelled under it; cancel() waits
  // for one that runs, so that it touches nothing that has gone.
  struct Alarm {
    Alarm(Clock& its_clock, Instant when, std::unique_lock<std::mutex>& its_lock,
          std::condition_variable& waiting)
        : clock(its_clock), lock(its_lock) {
      lock.unlock();
      timer = clock.call_at(when, [&mutex = *lock.mutex(), &waiting] {
        const std::lock_guard wakes(mutex);
        waiting.notify_all();
      });
      lock.lock();
    }
    ~Alarm() {
      lock.unlock();
      clock.cancel(timer);
      lock.lock();
    }
    Alarm(const Alarm&) = delete;
    Alarm& operator=(const Alarm&) = delete;

    Clock& clock;
    std::unique_lock<std::mutex>& lock;
    TimerId timer = 0;
  };

  while (!predicate()) {
    if (clock.now() >= deadline) return false;
    const Alarm alarm(clock, deadline, lock, changed);
    changed.wait(lock, [&] { return predicate() || clock.now() >= deadline; });
  }
  return true;
}

}  // namespace skein
