#pragma once

#include <pthread.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <cstdio>

namespace skein::command {

/// Lets a command that watches end in order: while this lives, SIGINT, SIGTERM and SIGHUP end
/// wait(), not the process. Make it before the entity, whose threads inherit what is blocked.
class Interruption {
 public:
  Interruption() {
    sigemptyset(&signals_);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&signals_, signal);
    pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
  }

  /// Until a signal comes, `seconds` have passed (0: no limit), or stdout takes no more.
  void wait(double seconds) const {
    using namespace std::chrono;
    const auto end = steady_clock::now() + duration_cast<nanoseconds>(duration<double>(seconds));
    while (std::ferror(stdout) == 0) {
      nanoseconds part = kLookAgain;
      if (seconds > 0) part = std::min<nanoseconds>(part, end - steady_clock::now());
      if (part <= nanoseconds(0)) return;
      const auto whole = duration_cast<std::chrono::seconds>(part);
      const timespec time{whole.count(), (part - whole).count()};
      if (sigtimedwait(&signals_, nullptr, &time) > 0) return;
    }
  }

 private:
  static constexpr std::chrono::milliseconds kLookAgain{200};
  sigset_t signals_{};
};

}  // namespace skein::command
