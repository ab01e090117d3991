#include <pthread.h>
#include <semaphore.h>

#include <array>
#include <atomic>
#include <cerrno>

#include "core/system/ending_signals.hpp"
#include "skein/error.hpp"
#include "skein/process.hpp"

namespace skein {
namespace {

/// Never destroyed: the handler may run until the very end.
struct Semaphore {
  Semaphore() { sem_init(&its, 0, 0); }
  sem_t its;
};

// What the handler uses.
Semaphore came;
std::atomic<int> latest{0};
static_assert(std::atomic<int>::is_always_lock_free);

/// Runs on whichever thread the kernel chooses; the one that waits has to be woken.
void handle(int signal) {
  const int error = errno;
  latest = signal;
  sem_post(&came.its);
  errno = error;
}

/// While it lives, signals that ask to end are handled as above.
class Handled {
 public:
  Handled() {
    struct sigaction action {};
    action.sa_handler = handle;
    action.sa_flags = SA_RESTART;  // system calls of the thread that is chosen go on
    for (std::size_t i = 0; i < kAll.size(); ++i) {
      if (sigismember(&signals_, kAll[i])) ::sigaction(kAll[i], &action, &actions_[i]);
    }
    pthread_sigmask(SIG_UNBLOCK, &signals_, &mask_);  // all threads may have blocked them
  }
  ~Handled() {
    pthread_sigmask(SIG_SETMASK, &mask_, nullptr);
    for (std::size_t i = 0; i < kAll.size(); ++i) {
      if (sigismember(&signals_, kAll[i])) ::sigaction(kAll[i], &actions_[i], nullptr);
    }
  }
  Handled(const Handled&) = delete;
  Handled& operator=(const Handled&) = delete;

 private:
  static constexpr std::array kAll{SIGTERM, SIGINT, SIGHUP};

  const sigset_t signals_ = ending_signals();
  std::array<struct sigaction, kAll.size()> actions_{};
  sigset_t mask_{};
};

}  // namespace

int wait_for_signal() {
  static std::atomic<bool> waiting{false};
  if (waiting.exchange(true)) {
    throw InvalidArgument(
        "wait_for_signal() is called while another thread waits in it; let one thread wait and "
        "tell the others");
  }
  while (sem_trywait(&came.its) == 0) {  // a signal that came beside the one that was told
  }
  {
    const Handled handled;
    while (sem_wait(&came.its) != 0) {
    }
  }
  const int signal = latest;
  waiting = false;
  return signal;
}

}  // namespace skein
