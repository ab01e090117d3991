#include "head_state.hpp"

#include <algorithm>
#include <utility>

#include "core/log.hpp"
#include "rpc/service/local_directory.hpp"
#include "skein/call_context.hpp"
#include "skein/error.hpp"
#include "skein/introspection.idl.hpp"

namespace skein {
namespace {

using introspection::Outcome;

constexpr std::chrono::seconds kWatchPeriod{1};

const std::string kOverdue = " has not returned from a request whose time is over";

}  // namespace

Head::State::State(const Parts& parts_, HeadOptions options_)
    : parts(parts_),
      options(std::move(options_)),
      decisions(parts, options.log),
      strategies(options),
      channels(parts),
      warnings(parts.entity),
      learning(parts.entity, options.history) {}

Head::State::~State() {
  std::unique_lock lock(mutex);
  const TimerId last = watch_timer;
  lock.unlock();
  parts.clock.cancel(last);
}

CircuitBreaker& Head::State::breaker(std::string_view interface, std::string_view csp) {
  const auto found = breakers.find(ByCsp::View(interface, csp));
  if (found != breakers.end()) return found->second;
  return breakers
      .try_emplace({std::string(interface), std::string(csp)}, CircuitBreaker(options.breaker))
      .first->second;
}

std::optional<std::uint64_t> Head::State::begin(const InterfaceInfo& interface,
                                                const Candidate& candidate, Instant now) {
  std::lock_guard lock(mutex);
  CircuitBreaker& breaker = this->breaker(interface.name, candidate.name);
  // Listed as open it is the last resort.
  if (breaker.state(now) == CircuitBreaker::State::Open &&
      candidate.breaker != CircuitBreaker::State::Open) {
    return std::nullopt;
  }
  breaker.begin(now);
  running.push_back(
      {++last_run, candidate.name, candidate.pid, host_of(interface, candidate.provider)});
  return last_run;
}

void Head::State::end(const InterfaceInfo& interface, const Candidate& candidate,
                      const std::shared_ptr<const Features>& features, std::uint64_t run,
                      const entity::Ending& ending) {
  const bool timed_out = ending.outcome == Outcome::TimedOut;
  const bool is_told = timed_out && ending.fault && ending.expected > Duration::zero() &&
                       !candidate.in_process && options.on_hang;
  {
    std::lock_guard lock(mutex);
    std::erase_if(running, [&](const Running& each) { return each.run == run; });
    CircuitBreaker& breaker = this->breaker(interface.name, candidate.name);
    if (is_told || ending.fault) {
      const Instant now = parts.clock.now();
      const bool was_closed = breaker.state(now) == CircuitBreaker::State::Closed;
      if (is_told) {  // it may be ended
        breaker.trip(now);
      } else {
        breaker.fail(now);
      }
      if (was_closed && breaker.state(now) != CircuitBreaker::State::Closed)
        warnings.tell(interface.name, candidate.name, " is in quarantine: " + ending.reason);
    } else if (ending.outcome == Outcome::Accepted || ending.outcome == Outcome::Refused) {
      breaker.succeed();
    } else {
      breaker.end();
    }
    if (timed_out && candidate.in_process)
      hung.insert_or_assign(candidate.provider, Hung{interface.name, candidate.name, ending.fault});
  }
  learning.add(interface, candidate, features, ending);
  if (is_told) options.on_hang(candidate);
}

Head::State::Watch::Watch(State& state, const InterfaceInfo& interface, const Candidate& candidate,
                          Instant end)
    : state_(state), interface_(interface.name), candidate_(candidate), end_(end) {
  if (!candidate.in_process) return;
  std::lock_guard lock(state.mutex);
  state.watches.push_back(this);
  if (state.watch_timer == 0) state.arm_watch_timer(end);
}

Head::State::Watch::~Watch() {
  if (!candidate_.in_process) return;
  std::lock_guard lock(state_.mutex);
  std::erase(state_.watches, this);
}

// Under the lock. Not one timer a request, which would cost it more than all else that a Head does.
void Head::State::arm_watch_timer(Instant next_end) {
  const Instant latest = parts.clock.now() + kWatchPeriod;
  watch_timer = parts.clock.call_at(std::min(next_end, latest), [this] { look_at_watches(); });
}

void Head::State::look_at_watches() {
  std::lock_guard lock(mutex);
  const Instant now = parts.clock.now();
  auto next_end = Instant::max();
  for (const Watch* watch : watches) {
    if (watch->end_ > now) {
      next_end = std::min(next_end, watch->end_);
      continue;
    }
    const auto service = parts.directory->find(watch->candidate_.provider);
    if (!service || service->thread() != CallThread::Caller) continue;
    warnings.tell(
        watch->interface_, watch->candidate_.name,
        kOverdue +
            "; it runs on its caller's thread, which waits for it: give it a thread of its "
            "own (CallThread::Own)");
  }
  watch_timer = 0;
  if (next_end != Instant::max()) arm_watch_timer(next_end);
}

std::size_t Head::State::count_stuck() {
  std::lock_guard lock(mutex);
  return stuck();
}

// Under the lock.
std::size_t Head::State::stuck() {
  std::erase_if(hung, [&](const auto& entry) {
    const auto service = parts.directory->find(entry.first);
    return !service || !service->overdue();
  });
  std::string names;
  for (auto& [provider, csp] : hung) {
    names += (names.empty() ? "" : ", ") + csp.csp;
    // Who is hardly late is told of only if he still is so when he is looked at again.
    if (std::exchange(csp.tell, true))
      warnings.tell(csp.interface, csp.csp, kOverdue + "; it is not asked again before it returns");
  }
  const std::size_t stuck = hung.size();
  const bool degraded = stuck >= options.max_stuck;
  if (degraded && !was_degraded) {
    log(LogLevel::Error, parts.entity,
        "CSPs in this process that do not return: " + names + "; as many as max_stuck (" +
            std::to_string(options.max_stuck) + "), so that it should be restarted");
  }
  was_degraded = degraded;
  return stuck;
}

void Head::State::conclude(introspection::Decision&& record, introspection::Decision* wanted) {
  const bool explored = std::any_of(record.attempts.begin(), record.attempts.end(),
                                    [](const auto& attempt) { return attempt.explores; });
  {
    std::lock_guard lock(mutex);
    record.stuck = static_cast<std::uint32_t>(stuck());
  }
  learning.end_request(record.service, explored);
  decisions.add(std::move(record), wanted);
}

}  // namespace skein
