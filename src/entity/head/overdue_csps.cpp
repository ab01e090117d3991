#include "overdue_csps.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "core/log.hpp"

namespace skein::entity {
namespace {

constexpr std::chrono::seconds kWatchPeriod{1};

const std::string kOverdue = " has not returned from a request whose time is over";

}  // namespace

OverdueCsps::OverdueCsps(std::string entity, Clock& clock, std::size_t most, Providers providers,
                         HeadWarnings& warnings)
    : entity_(std::move(entity)),
      clock_(clock),
      most_(most),
      providers_(std::move(providers)),
      warnings_(warnings) {}

OverdueCsps::~OverdueCsps() {
  std::unique_lock lock(mutex_);
  const TimerId last = timer_;
  lock.unlock();
  clock_.cancel(last);
}

OverdueCsps::Watch::Watch(OverdueCsps& csps, const InterfaceInfo& interface,
                          const Candidate& candidate, Instant end)
    : csps_(csps), interface_(interface.name), candidate_(candidate), end_(end) {
  if (!candidate.in_process) return;
  std::lock_guard lock(csps.mutex_);
  csps.watches_.push_back(this);
  if (csps.timer_ == 0) csps.arm(end);
}

OverdueCsps::Watch::~Watch() {
  if (!candidate_.in_process) return;
  std::lock_guard lock(csps_.mutex_);
  std::erase(csps_.watches_, this);
}

// Under the lock. Not one timer a request, which would cost it more than all else that a Head does.
void OverdueCsps::arm(Instant next_end) {
  const Instant latest = clock_.now() + kWatchPeriod;
  timer_ = clock_.call_at(std::min(next_end, latest), [this] { look(); });
}

// Logs under the lock: without it, the watch may end, and with it the candidate.
void OverdueCsps::look() {
  std::lock_guard lock(mutex_);
  const Instant now = clock_.now();
  auto next_end = Instant::max();
  for (const Watch* watch : watches_) {
    if (watch->end_ > now) {
      next_end = std::min(next_end, watch->end_);
      continue;
    }
    if (!providers_.runs_on_caller(watch->candidate_.provider)) continue;
    warnings_.tell(watch->interface_, watch->candidate_.name,
                   kOverdue +
                       "; it runs on its caller's thread, which waits for it: give it a thread "
                       "of its own (CallThread::Own)");
  }
  timer_ = 0;
  if (next_end != Instant::max()) arm(next_end);
}

void OverdueCsps::add(const InterfaceInfo& interface, const Candidate& candidate, bool hangs) {
  std::lock_guard lock(mutex_);
  overdue_.insert_or_assign(candidate.provider, Overdue{interface.name, candidate.name, hangs});
}

std::size_t OverdueCsps::count() {
  std::lock_guard lock(mutex_);
  std::erase_if(overdue_, [&](const auto& entry) { return !providers_.is_overdue(entry.first); });
  std::string names;
  for (auto& [provider, csp] : overdue_) {
    names += (names.empty() ? "" : ", ") + csp.csp;
    // A CSP that is slightly late is logged only if it is still late at the next count.
    if (std::exchange(csp.tell, true))
      warnings_.tell(csp.interface, csp.csp,
                     kOverdue + "; it is not asked again before it returns");
  }
  const bool degraded = overdue_.size() >= most_;
  if (degraded && !was_degraded_) {
    log(LogLevel::Error, entity_,
        "CSPs in this process that do not return: " + names + "; as many as max_stuck (" +
            std::to_string(most_) + "), so that it should be restarted");
  }
  was_degraded_ = degraded;
  return overdue_.size();
}

}  // namespace skein::entity
