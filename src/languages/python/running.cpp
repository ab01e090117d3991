#include "running.hpp"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <vector>

namespace skein::python {
namespace {

/// Threads that are in Python, though it is not theirs, or that have left it for Skein.
struct Visitors {
  std::mutex mutex;
  std::condition_variable changed;
  std::vector<unsigned long> inside;
  int outside = 0;
  bool closed = false;

  static Visitors& all() {
    static auto& visitors = *new Visitors();
    return visitors;
  }

  /// Under the lock.
  bool wait(std::unique_lock<std::mutex>& lock) {
    return changed.wait_for(lock, std::chrono::seconds(2),
                            [this] { return inside.empty() && outside == 0; });
  }
};

[[noreturn]] void wait_for_ever() {
  for (;;) ::pause();
}

unsigned long main_thread = 0;

/// Calls a function at SIGINT, then the handler that was installed before. That is Python's: it
/// runs the function that signal.signal() was given, but not while the main thread waits.
class SignalWatch {
 public:
  static SignalWatch& instance() {
    static auto& watch = *new SignalWatch();
    return watch;
  }

  void set(std::function<void()> interrupt) {
    if (interrupt) listen();
    std::lock_guard lock(mutex_);
    interrupt_ = std::move(interrupt);
  }

 private:
  SignalWatch() {
    if (::pipe2(pipe_.data(), O_CLOEXEC | O_NONBLOCK) == 0)
      std::thread([this] { watch(); }).detach();
  }

  /// Puts this handler before the present one. A later signal.signal() replaces it.
  void listen() {
    struct sigaction now {};
    ::sigaction(SIGINT, nullptr, &now);
    const bool handled = now.sa_handler != SIG_DFL && now.sa_handler != SIG_IGN;
    if (!handled || now.sa_sigaction == &handle) return;
    previous_ = now;
    now.sa_sigaction = &handle;
    now.sa_flags |= SA_SIGINFO;
    ::sigaction(SIGINT, &now, nullptr);
  }

  static void handle(int signal, siginfo_t* info, void* context) {
    const int error = errno;
    const SignalWatch& watch = instance();
    [[maybe_unused]] const auto written = ::write(watch.pipe_[1], "", 1);
    errno = error;
    const struct sigaction& before = watch.previous_;
    if (before.sa_flags & SA_SIGINFO) return before.sa_sigaction(signal, info, context);
    before.sa_handler(signal);
  }

  void watch() {
    for (;;) {
      pollfd watched{pipe_[0], POLLIN, 0};
      char signals[16];
      if (::poll(&watched, 1, -1) < 0 || ::read(pipe_[0], signals, sizeof signals) <= 0) continue;
      std::lock_guard lock(mutex_);
      if (interrupt_) std::exchange(interrupt_, nullptr)();
    }
  }

  std::array<int, 2> pipe_{-1, -1};
  struct sigaction previous_ {};
  std::mutex mutex_;
  std::function<void()> interrupt_;
};

}  // namespace

Unlocked::Unlocked() : state_(PyEval_SaveThread()) {
  auto& visitors = Visitors::all();
  std::lock_guard lock(visitors.mutex);
  ++visitors.outside;
}

Unlocked::~Unlocked() {
  auto& visitors = Visitors::all();
  const bool main = is_main_thread();
  {
    std::unique_lock lock(visitors.mutex);
    if (visitors.closed && !main) {
      --visitors.outside;
      std::erase(visitors.inside, PyThread_get_thread_ident());
      visitors.changed.notify_all();
      lock.unlock();
      wait_for_ever();
    }
  }
  PyEval_RestoreThread(state_);
  std::lock_guard lock(visitors.mutex);
  --visitors.outside;
  visitors.changed.notify_all();
}

Entered::Entered() {
  auto& visitors = Visitors::all();
  {
    std::lock_guard lock(visitors.mutex);
    if (visitors.closed || is_forked()) return;
    visitors.inside.push_back(PyThread_get_thread_ident());
  }
  state_ = PyGILState_Ensure();
}

Entered::~Entered() {
  if (!state_) return;
  PyGILState_Release(*state_);
  auto& visitors = Visitors::all();
  std::lock_guard lock(visitors.mutex);
  visitors.inside.erase(std::ranges::find(visitors.inside, PyThread_get_thread_ident()));
  visitors.changed.notify_all();
}

bool leave_python() {
  auto& visitors = Visitors::all();
  std::vector<unsigned long> late;
  {
    const py::gil_scoped_release unlocked;
    std::unique_lock lock(visitors.mutex);
    visitors.closed = true;
    if (visitors.wait(lock)) return true;
    late = visitors.inside;
  }
  for (const unsigned long thread : late) PyThreadState_SetAsyncExc(thread, PyExc_SystemExit);
  const py::gil_scoped_release unlocked;
  std::unique_lock lock(visitors.mutex);
  return visitors.wait(lock);
}

bool is_main_thread() { return PyThread_get_thread_ident() == main_thread; }

void set_main_thread(unsigned long identity) { main_thread = identity; }

Interruptible::Interruptible(std::function<void()> interrupt) : main_(is_main_thread()) {
  if (!main_) return;
  SignalWatch::instance().set(std::move(interrupt));
  try {
    handle_signals();
  } catch (...) {
    SignalWatch::instance().set(nullptr);
    throw;
  }
}

Interruptible::~Interruptible() {
  if (main_) SignalWatch::instance().set(nullptr);
}

}  // namespace skein::python
