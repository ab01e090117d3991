#pragma once

#include <signal.h>

#include <cerrno>
#include <ctime>

namespace skein {

/// While it lives, one of the signals by which the kernel comments on a thread's own system call
/// (SIGXFSZ beyond `ulimit -f`, SIGPIPE without a reader) does not end the process: the call only
/// fails, with EFBIG or EPIPE. A library must not change the signal's disposition, which belongs to
/// the program, so this blocks the signal in this thread alone and then takes it away.
class HeldSignal {
 public:
  explicit HeldSignal(int signal) noexcept {
    sigemptyset(&signal_);
    sigaddset(&signal_, signal);
    sigset_t pending;
    sigpending(&pending);
    was_pending_ = sigismember(&pending, signal) == 1;
    pthread_sigmask(SIG_BLOCK, &signal_, &before_);
  }
  /// Keeps errno.
  ~HeldSignal() {
    const int error = errno;
    const timespec at_once{};
    while (!was_pending_ && sigtimedwait(&signal_, nullptr, &at_once) < 0 && errno == EINTR) {
    }
    pthread_sigmask(SIG_SETMASK, &before_, nullptr);
    errno = error;
  }
  HeldSignal(const HeldSignal&) = delete;
  HeldSignal& operator=(const HeldSignal&) = delete;

 private:
  sigset_t signal_{};
  sigset_t before_{};
  bool was_pending_ = false;
};

/// Makes a system call that makes a file larger: beyond `ulimit -f` it fails with EFBIG.
template <class Call>
auto within_file_size(const Call& call) {
  const HeldSignal held(SIGXFSZ);
  return call();
}

}  // namespace skein
