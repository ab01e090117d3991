#pragma once

#include <signal.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <chrono>

namespace skein::test {

/// Stops another process, as SIGSTOP does, for so long. Makes system calls only.
inline void stop_process(pid_t process, std::chrono::milliseconds length) {
  const timespec time{length.count() / 1000, length.count() % 1000 * 1'000'000};
  ::kill(process, SIGSTOP);
  ::nanosleep(&time, nullptr);
  ::kill(process, SIGCONT);
}

/// The same of this one. Returns when its other threads have gone on for a moment.
inline void stop_this_process(std::chrono::milliseconds length) {
  const pid_t stopped = ::getpid();
  const pid_t stops = ::fork();
  if (stops == 0) {
    stop_process(stopped, length);
    ::_exit(0);
  }
  ::waitpid(stops, nullptr, 0);
  const timespec moment{0, 20'000'000};
  ::nanosleep(&moment, nullptr);
}

}  // namespace skein::test
