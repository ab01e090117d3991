#include "wake_up.hpp"

#include <sys/eventfd.h>
#include <sys/signalfd.h>

#include <cerrno>
#include <cstdint>
#include <system_error>

#include "core/system/ending_signals.hpp"
#include "core/system/passing_error.hpp"

namespace skein::launch {

SystemError::SystemError(const std::string& what, int number)
    : Unavailable(what + ": " + std::generic_category().message(number)), number_(number) {}

bool SystemError::is_passing() const noexcept { return skein::is_passing(number_); }

void throw_system_error(const char* what) {
  throw SystemError(std::string("the launcher cannot make ") + what, errno);
}

StopRequest::StopRequest() : event_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (!event_) throw_system_error("an event descriptor");
}

void StopRequest::raise() noexcept {
  const std::uint64_t one = 1;
  // Fails only when it was raised 2^64 - 2 times already, which wakes up just as well.
  [[maybe_unused]] const auto written = ::write(event_.get(), &one, sizeof one);
}

bool StopRequest::take() noexcept {
  std::uint64_t count = 0;
  return ::read(event_.get(), &count, sizeof count) == sizeof count;
}

SignalReader::SignalReader() {
  const sigset_t wanted = ending_signals();
  signals_ = FileDescriptor(::signalfd(-1, &wanted, SFD_CLOEXEC | SFD_NONBLOCK));
  if (!signals_) throw_system_error("a signal descriptor");
  pthread_sigmask(SIG_BLOCK, &wanted, &before_);
}

SignalReader::~SignalReader() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

SignalReader::Signal SignalReader::take() noexcept {
  signalfd_siginfo information{};
  const auto size = ::read(signals_.get(), &information, sizeof information);
  if (size != sizeof information) return {};
  const bool from_process = information.ssi_code <= 0;  // SI_USER, SI_QUEUE, SI_TKILL
  return {static_cast<int>(information.ssi_signo),
          from_process ? static_cast<pid_t>(information.ssi_pid) : 0};
}

}  // namespace skein::launch
