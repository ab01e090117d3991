#include "mission/process/progress_report.hpp"

#include <atomic>
#include <mutex>
#include <string>

#include "core/log.hpp"
#include "mission/process/ready.hpp"
#include "skein/entity.hpp"

namespace skein::launch {
namespace {

constexpr int kReportsInTimeout = 4;

}  // namespace

struct ProgressReport::State : std::enable_shared_from_this<State> {
  State(Entity& its_entity, Duration timeout)
      : entity(its_entity), period(timeout / kReportsInTimeout) {}

  /// On the clock's thread.
  void beat() {
    if (!asked.exchange(true)) {
      const bool posted = entity.check_progress(
          [self = shared_from_this()](const std::string& stuck) { self->tell(stuck); });
      if (!posted) asked = false;
    }
    schedule();
  }

  void schedule() {
    const std::lock_guard lock(mutex);
    if (!ended)
      timer = entity.clock().call_after(period, [self = shared_from_this()] { self->beat(); });
  }

  /// On the entity's control thread.
  void tell(const std::string& stuck) {
    if (stuck.empty()) {
      report_progress();
    } else if (stuck != told) {
      report_waiting(stuck);
      log(LogLevel::Error, "launch", stuck);
    }
    told = stuck;
    asked = false;
  }

  void end() {
    std::unique_lock lock(mutex);
    ended = true;
    const TimerId last = timer;
    lock.unlock();
    entity.clock().cancel(last);
  }

  Entity& entity;
  const Duration period;
  std::atomic<bool> asked{false};  // the control thread has not answered yet
  std::string told;                // the control thread's
  std::mutex mutex;
  TimerId timer = 0;
  bool ended = false;
};

ProgressReport::ProgressReport(Entity& entity, Duration timeout) {
  if (timeout <= Duration::zero()) return;
  state_ = std::make_shared<State>(entity, timeout);
  state_->beat();
}

ProgressReport::~ProgressReport() {
  if (state_) state_->end();
}

}  // namespace skein::launch
