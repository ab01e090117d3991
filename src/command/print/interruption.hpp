#pragma once

#include <pthread.h>
#include <signal.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <functional>
#include <string>

#include "core/system/ending_signals.hpp"
#include "core/system/file_descriptor.hpp"
#include "skein/error.hpp"

namespace skein::command {

/// A signal ended a command before it was done.
class Interrupted : public Cancelled {
 public:
  Interrupted(const std::string& text, int signal) : Cancelled(text), signal_(signal) {}
  int signal() const noexcept { return signal_; }

 private:
  int signal_;
};

/// Lets a command that watches end in order: while this lives, SIGTERM, SIGINT and SIGHUP, unless
/// they are ignored, end wait(), not the process. Make it before the entity, whose threads inherit
/// what is blocked.
class Interruption {
 public:
  Interruption() { pthread_sigmask(SIG_BLOCK, &signals_, nullptr); }

  /// Until a signal comes or end() is called (true then), `seconds` have passed (0: no limit), or
  /// stdout takes no more.
  bool wait(double seconds) const {
    using namespace std::chrono;
    const auto end = steady_clock::now() + duration_cast<nanoseconds>(duration<double>(seconds));
    while (!came()) {
      nanoseconds part = kLookAgain;
      if (seconds > 0) part = std::min<nanoseconds>(part, end - steady_clock::now());
      if (part <= nanoseconds(0)) return false;
      if (takes_signal(part)) return true;
    }
    return true;
  }

  /// As a signal would; from any thread.
  void end() const { ::kill(::getpid(), SIGTERM); }

  /// Whether a signal has come, or stdout takes no more. Does not wait.
  bool came() const {
    return std::ferror(stdout) != 0 || signal_ != 0 || takes_signal(std::chrono::nanoseconds(0));
  }

  /// For whoever waits for others' answers: true from 0.3 s after a signal on. Until then what has
  /// come so far, and what still comes at once, is told all the same. From any thread.
  std::function<bool()> gives_up() const {
    return [this] {
      return came() && std::chrono::steady_clock::now().time_since_epoch() > came_.load() + kGrace;
    };
  }

  /// The latest signal that came; 0: none.
  int signal() const noexcept { return signal_; }

  /// Can be read while a signal has come that nobody here has told of: for poll().
  FileDescriptor descriptor() const {
    return FileDescriptor(::signalfd(-1, &signals_, SFD_CLOEXEC | SFD_NONBLOCK));
  }

 private:
  static constexpr std::chrono::milliseconds kLookAgain{200};
  static constexpr std::chrono::milliseconds kGrace{300};

  bool takes_signal(std::chrono::nanoseconds within) const {
    const auto whole = std::chrono::duration_cast<std::chrono::seconds>(within);
    const timespec time{whole.count(), (within - whole).count()};
    const int taken = sigtimedwait(&signals_, nullptr, &time);
    if (taken <= 0) return false;
    came_ = std::chrono::steady_clock::now().time_since_epoch();
    signal_ = taken;
    return true;
  }

  const sigset_t signals_ = ending_signals();
  mutable std::atomic<std::chrono::nanoseconds> came_{std::chrono::nanoseconds(0)};
  mutable std::atomic<int> signal_ = 0;
};

}  // namespace skein::command
