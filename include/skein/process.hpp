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

}  // namespace skein
