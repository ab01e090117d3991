#pragma once

#include <cstdint>
#include <mutex>

namespace skein::c {

/// The callbacks that a user gave, until `on_close` has been called. Thread-safe.
class CallbackGate {
 public:
  /// `entity` is the handle of the entity whose callbacks these are.
  CallbackGate(std::uint64_t entity, void* user, void (*on_close)(void* user))
      : entity_(entity), user_(user), on_close_(on_close) {}
  CallbackGate(const CallbackGate&) = delete;
  CallbackGate& operator=(const CallbackGate&) = delete;

  /// Runs a callback, without a lock. Returns false, and does not run it, after close().
  template <class Callback>
  bool run(const Callback& callback) {
    if (!enter()) return false;
    {
      const Frame frame(*this);
      callback(user_);
    }
    leave();
    return true;
  }

  /// No further callback begins. `on_close` is called when none runs any more: here, or by the
  /// thread of the last one. Twice is no error.
  void close();

  /// Whether this thread is in one of these callbacks.
  bool is_inside() const noexcept;
  /// Whether this thread is in any callback of that entity.
  static bool is_inside(std::uint64_t entity) noexcept;

 private:
  /// On the stack of a thread that is in a callback.
  struct Frame {
    explicit Frame(const CallbackGate& gate_);
    ~Frame();
    Frame(const Frame&) = delete;
    Frame& operator=(const Frame&) = delete;
    const CallbackGate& gate;
    const Frame* const outer;
  };

  bool enter();
  void leave();

  static thread_local const Frame* innermost_;

  const std::uint64_t entity_;
  void* const user_;
  void (*const on_close_)(void* user);
  std::mutex mutex_;
  std::uint32_t running_ = 0;
  bool closed_ = false;
};

}  // namespace skein::c
