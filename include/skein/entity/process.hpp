#pragma once

#include <memory>

#include "skein/brokerless_discovery/process_watch.hpp"
#include "skein/core/clock.hpp"
#include "skein/rpc/local_directory.hpp"

namespace skein {

/// What the entities of one process share: time, the watch over other processes, and the services
/// that are reached without leaving the process. Composition roots make one.
class Process {
 public:
  /// On the machine's clock.
  Process();
  /// On a clock of the caller's.
  explicit Process(std::shared_ptr<Clock> clock);

  Clock& clock() const noexcept { return *clock_; }
  /// For what may outlive the process's entities.
  const std::shared_ptr<Clock>& shared_clock() const noexcept { return clock_; }
  brokerless_discovery::ProcessWatch& watch() noexcept { return watch_; }
  const std::shared_ptr<rpc::LocalDirectory>& directory() const noexcept { return directory_; }

 private:
  std::shared_ptr<Clock> clock_;
  brokerless_discovery::ProcessWatch watch_;
  std::shared_ptr<rpc::LocalDirectory> directory_ = std::make_shared<rpc::LocalDirectory>();
};

}  // namespace skein
