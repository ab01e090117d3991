#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "languages/c/errors.hpp"
#include "skein/error.hpp"

/// Skein for Python: what `skein/*.py` stands on. Functions hold the GIL unless they say otherwise.
namespace skein::python {

namespace py = pybind11;

class Interface;

/// Gives the Python classes of errors: a tuple by skein_error_kind, whose first one is that of all.
void set_error_classes(py::tuple classes);

/// Throws the failure as a Python exception. One that IDL declares is made by `known`.
[[noreturn]] void raise(const c::Failure& failure, const Interface* known = nullptr);
/// Throws InvalidArgument of Python.
[[noreturn]] void refuse(const std::string& text);

/// What `read()` returns; what C++ throws there, it throws as a Python exception.
template <class Read>
auto decoded(const Read& read) {
  try {
    return read();
  } catch (const Error&) {
    raise(c::failure_of(std::current_exception()));
  }
}

/// Why the last function of skein.h on this thread has failed.
std::shared_ptr<const c::Failure> last_failure();
/// Where functions of skein.h put it.
skein_error sink();

/// Forbids all use of Skein: this process is a child of fork(), in which its threads do not run.
void forbid_after_fork();
/// Whether that was called.
bool is_forked();
/// Throws RuntimeError then.
void refuse_after_fork();

/// Gives the GIL away while it lives. A thread that comes back when the interpreter ends waits for
/// ever: Python would end it, and unwind through destructors.
class Unlocked {
 public:
  Unlocked();
  ~Unlocked();
  Unlocked(const Unlocked&) = delete;
  Unlocked& operator=(const Unlocked&) = delete;

 private:
  PyThreadState* const state_;
};

/// Runs `function(sink)` of skein.h without the GIL, and throws what it fails with.
template <class Function>
void run(const Function& function, const Interface* known = nullptr) {
  refuse_after_fork();
  bool done = false;
  {
    const Unlocked unlocked;
    done = function(sink());
  }
  if (!done) raise(*last_failure(), known);
}

/// A handle of skein.h that is freed at the end, without the GIL: that may wait for a callback. In
/// a callback for which it would wait, another thread frees it.
template <class Named, bool (*free)(Named, skein_error)>
class Owned {
 public:
  Owned() = default;
  explicit Owned(Named handle) : handle_(handle) {}
  Owned(Owned&& other) noexcept
      : handle_(std::exchange(other.handle_, {})), closed_(other.closed_.load()) {}
  Owned& operator=(Owned&& other) noexcept {
    std::swap(handle_, other.handle_);
    closed_ = other.closed_.exchange(closed_);
    return *this;
  }
  ~Owned() {
    if (handle_.id == 0 || closed_ || is_forked()) return;
    std::optional<Unlocked> unlocked;
    if (PyGILState_Check() != 0) unlocked.emplace();
    if (!free(handle_, {})) std::thread([handle = handle_] { free(handle, {}); }).detach();
  }

  /// Functions of skein.h refuse it in words after close().
  Named operator*() const noexcept { return handle_; }
  bool closed() const noexcept { return closed_; }
  /// Frees it now, and throws if that is refused. Twice is no error.
  void close() {
    if (closed_.exchange(true)) return;
    try {
      run([this](skein_error error) { return free(handle_, error); });
    } catch (...) {
      closed_ = false;
      throw;
    }
  }
  /// It was freed otherwise.
  void release() noexcept { closed_ = true; }

 private:
  Named handle_{};
  std::atomic<bool> closed_ = false;
};

}  // namespace skein::python
