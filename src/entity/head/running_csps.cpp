#include "running_csps.hpp"

namespace skein::entity {

using introspection::Outcome;

CircuitBreaker& RunningCsps::breaker(std::string_view interface, std::string_view csp) {
  const auto found = breakers_.find(ByCsp::View(interface, csp));
  if (found != breakers_.end()) return found->second;
  return breakers_.try_emplace({std::string(interface), std::string(csp)}, CircuitBreaker(rules_))
      .first->second;
}

void RunningCsps::note_quarantine(const InterfaceInfo& interface,
                                  std::vector<Candidate>& candidates, Instant now) const {
  std::lock_guard lock(mutex_);
  for (Candidate& candidate : candidates) {
    const auto found = breakers_.find(ByCsp::View(interface.name, candidate.name));
    if (found == breakers_.end()) continue;
    candidate.breaker = found->second.state(now);
    if (candidate.breaker != CircuitBreaker::State::Closed)
      candidate.quarantine = found->second.quarantine(now);
  }
}

std::optional<std::uint64_t> RunningCsps::begin(const InterfaceInfo& interface,
                                                const Candidate& candidate,
                                                std::shared_ptr<const std::string> host,
                                                Instant now) {
  std::lock_guard lock(mutex_);
  CircuitBreaker& breaker = this->breaker(interface.name, candidate.name);
  // Listed as open it is the last resort.
  if (breaker.state(now) == CircuitBreaker::State::Open &&
      candidate.breaker != CircuitBreaker::State::Open) {
    return std::nullopt;
  }
  breaker.begin(now);
  running_.push_back({++last_run_, candidate.name, candidate.pid, std::move(host)});
  return last_run_;
}

void RunningCsps::end(const InterfaceInfo& interface, const Candidate& candidate, std::uint64_t run,
                      const RunEnding& ending, bool hangs) {
  std::lock_guard lock(mutex_);
  std::erase_if(running_, [&](const Running& each) { return each.run == run; });
  CircuitBreaker& breaker = this->breaker(interface.name, candidate.name);
  if (ending.fault) {
    const Instant now = clock_.now();
    const bool was_closed = breaker.state(now) == CircuitBreaker::State::Closed;
    if (hangs) {  // it may be ended
      breaker.trip(now);
    } else {
      breaker.fail(now);
    }
    if (was_closed && breaker.state(now) != CircuitBreaker::State::Closed)
      warnings_.tell(interface.name, candidate.name, " is in quarantine: " + ending.reason);
  } else if (ending.outcome == Outcome::Accepted || ending.outcome == Outcome::Refused) {
    breaker.succeed();
  } else {
    breaker.end();
  }
}

std::vector<Head::Current> RunningCsps::list() const {
  std::lock_guard lock(mutex_);
  std::vector<Head::Current> running;
  for (const Running& each : running_)
    running.push_back({each.csp, each.pid, each.host ? *each.host : std::string()});
  return running;
}

}  // namespace skein::entity
