#pragma once

#include <signal.h>
#include <time.h>

#include <chrono>

namespace skein::test {

/// Stops another process, as SIGSTOP does, for so long. Makes system calls only.
inline void stop_process(pid_t process, std::chrono::milliseconds length) {
  const timespec time{length.count() / 1000, length.count() % 1000 * 1'000'000};
  ::kill(process, SIGSTOP);
  ::nanosleep(&time, nullptr);
  ::kill(process, SIGCONT);
}

}  // namespace skein::test
