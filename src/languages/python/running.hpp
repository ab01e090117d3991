#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "raising.hpp"

namespace skein::python {

/// Python may run on this thread, which is one of Skein's, while this lives: it has the GIL.
class Entered {
 public:
  Entered();
  ~Entered();
  Entered(const Entered&) = delete;
  Entered& operator=(const Entered&) = delete;

  /// False once the interpreter has begun to end: then nothing of Python may be touched.
  explicit operator bool() const noexcept { return state_.has_value(); }

 private:
  std::optional<PyGILState_STATE> state_;
};

/// `on_close` of callbacks whose `user` holds objects of Python's.
template <class User>
void drop(void* user) {
  const Entered entered;
  if (entered) delete static_cast<User*>(user);
}

/// No thread of Skein's enters Python any more, and none comes back to it. Waits for those that are
/// there, without the GIL, at most 2 s; then throws SystemExit in them, and waits again. Whether
/// all have left: the interpreter cannot end otherwise.
bool leave_python();

/// Runs the handlers of signals that have come, and throws what they throw: KeyboardInterrupt.
inline void handle_signals() {
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

/// Whether this is the thread on which Python handles signals.
bool is_main_thread();
void set_main_thread(unsigned long identity);

/// While it lives, SIGINT (Ctrl-C) calls `interrupt`, once, on another thread, if Python has a
/// handler for it. For the main thread; does nothing on others. Throws what the handler of an
/// earlier signal throws.
class Interruptible {
 public:
  explicit Interruptible(std::function<void()> interrupt);
  ~Interruptible();
  Interruptible(const Interruptible&) = delete;
  Interruptible& operator=(const Interruptible&) = delete;

 private:
  const bool main_;
};

/// As run(), for a function that cannot be told to end: on the main thread Ctrl-C ends the wait,
/// and the function goes on to its own end elsewhere. It must own what it uses, and its result must
/// free itself.
template <class Result>
Result wait_for(const std::function<bool(Result&, skein_error)>& function,
                const Interface* known = nullptr) {
  refuse_after_fork();
  if (!is_main_thread()) {
    Result result;
    run([&](skein_error error) { return function(result, error); }, known);
    return result;
  }
  struct State {
    std::mutex mutex;
    std::condition_variable changed;
    Result result{};
    std::shared_ptr<const c::Failure> failure;
    bool ended = false;
  };
  const auto state = std::make_shared<State>();
  std::thread([state, function] {
    const bool done = function(state->result, sink());
    std::lock_guard lock(state->mutex);
    if (!done) state->failure = last_failure();
    state->ended = true;
    state->changed.notify_all();
  }).detach();
  for (bool ended = false; !ended;) {
    {
      const Unlocked unlocked;
      std::unique_lock lock(state->mutex);
      ended = state->changed.wait_for(lock, std::chrono::milliseconds(50),
                                      [&] { return state->ended; });
    }
    if (!ended) handle_signals();
  }
  if (state->failure) raise(*state->failure, known);
  return std::move(state->result);
}

}  // namespace skein::python
