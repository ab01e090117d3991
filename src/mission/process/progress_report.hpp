#pragma once

#include <memory>

#include "skein/clock.hpp"

namespace skein {
class Entity;
}

namespace skein::launch {

/// While it lives, tells the launcher several times within each `timeout` that an entity makes
/// progress (report_progress), as long as Entity::check_progress() says so. When it does not, says
/// once why (report_waiting, and in the log).
class ProgressReport {
 public:
  /// `entity` outlives this object. A `timeout` of zero: nobody asks, and nothing is told.
  ProgressReport(Entity& entity, Duration timeout);
  ~ProgressReport();
  ProgressReport(const ProgressReport&) = delete;
  ProgressReport& operator=(const ProgressReport&) = delete;

 private:
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace skein::launch
