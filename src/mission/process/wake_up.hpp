#pragma once

#include <csignal>
#include <string>

#include "core/system/file_descriptor.hpp"
#include "skein/error.hpp"

namespace skein::launch {

/// What the operating system refused, and why.
class SystemError : public Unavailable {
 public:
  SystemError(const std::string& what, int number);
  /// Whether it may be granted a moment later.
  bool is_passing() const noexcept;

 private:
  int number_;
};

/// Throws SystemError: what the launcher cannot make, by errno.
[[noreturn]] void throw_system_error(const char* what);

/// Wakes up a poll() from any thread or signal handler.
class StopRequest {
 public:
  StopRequest();
  void raise() noexcept;
  bool take() noexcept;  ///< Whether it was raised since the last time.
  int descriptor() const noexcept { return event_.get(); }

 private:
  FileDescriptor event_;
};

/// While it lives, SIGINT, SIGTERM and SIGHUP, unless they are ignored, are read from a descriptor
/// instead of ending the process; afterwards everything is as before, signals that came in between
/// and were not read included.
class SignalReader {
 public:
  SignalReader();
  SignalReader(const SignalReader&) = delete;
  SignalReader& operator=(const SignalReader&) = delete;
  ~SignalReader();
  struct Signal {
    int number = 0;    ///< 0: none.
    pid_t sender = 0;  ///< 0: the kernel, as for Ctrl-C.
  };
  Signal take() noexcept;  ///< The next one.
  int descriptor() const noexcept { return signals_.get(); }

 private:
  sigset_t before_{};
  FileDescriptor signals_;
};

}  // namespace skein::launch
