#pragma once

#include <memory>

#include "skein/clock.hpp"

namespace skein::brokerless_discovery {
class ProcessWatch;
}
namespace skein::rpc {
class LocalDirectory;
}

namespace skein {

/// What the entities of one process share: the clock, the watch over other processes, and the
/// services that are reached without leaving the process. Composition roots make one.
class Process {
 public:
  /// With a SystemClock.
  Process();
  /// With the caller's clock.
  explicit Process(std::shared_ptr<Clock> clock);
  ~Process();

  Clock& clock() const noexcept { return *clock_; }
  /// For objects that may outlive the process's entities.
  const std::shared_ptr<Clock>& shared_clock() const noexcept { return clock_; }
  brokerless_discovery::ProcessWatch& watch() noexcept { return *watch_; }
  const std::shared_ptr<rpc::LocalDirectory>& directory() const noexcept { return directory_; }

 private:
  std::shared_ptr<Clock> clock_;
  std::unique_ptr<brokerless_discovery::ProcessWatch> watch_;
  std::shared_ptr<rpc::LocalDirectory> directory_;
};

/// Waits until this process is told to end, and returns the signal by which it was: SIGTERM, SIGINT
/// (Ctrl-C) or SIGHUP. What a program does whose entities work by themselves:
///
///     entity.provide<greeting::IGreeter>(std::make_shared<Greeter>());
///     skein::wait_for_signal();
///
/// It may be called however many threads there are already, and it does not matter whether some of
/// them, or all, block these signals. A signal that the process ignores when the call begins stays
/// ignored: nohup has it ignore SIGHUP, a script has what it starts by `&` ignore SIGINT.
///
/// While the call lasts it takes the place of the process's own handlers of these signals; before
/// and after it they act as usual, so that a second Ctrl-C ends a program whose end takes long.
/// Peers that `skein launch` starts do not need it: their code is told to end (see await_end()).
///
/// One thread at a time: throws InvalidArgument while another one waits.
int wait_for_signal();

}  // namespace skein
