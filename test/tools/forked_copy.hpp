#pragma once

#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>

namespace skein::test {

/// A child that was forked and does nothing: it keeps a copy of each descriptor open as long as
/// this lives, or at most as the thread that made it.
class ForkedCopy {
 public:
  ForkedCopy() : pid_(::fork()) {
    REQUIRE(pid_ >= 0);
    if (pid_ > 0) return;
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    while (true) ::pause();
  }
  ~ForkedCopy() {
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }
  ForkedCopy(const ForkedCopy&) = delete;
  ForkedCopy& operator=(const ForkedCopy&) = delete;

 private:
  const pid_t pid_;
};

}  // namespace skein::test
