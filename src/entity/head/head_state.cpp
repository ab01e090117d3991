#include "head_state.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "rpc/service/local_directory.hpp"

namespace skein {
namespace {

// Nobody tells a Head that waits that its caller has given up.
constexpr std::chrono::milliseconds kLookPeriod{100};

}  // namespace

Head::State::State(const Parts& parts_, HeadOptions options_)
    : parts(parts_),
      options(std::move(options_)),
      decisions(parts, options.log),
      strategies(options),
      warnings(parts.entity),
      known(parts),
      channels(parts),
      running(parts.clock, options.breaker, warnings),
      overdue(parts.entity, parts.clock, options.max_stuck,
              {[&directory = *parts.directory](const Guid& provider) {
                 const auto service = directory.find(provider);
                 return service && service->overdue();
               },
               [&directory = *parts.directory](const Guid& provider) {
                 const auto service = directory.find(provider);
                 return service && service->thread() == CallThread::Caller;
               }},
              warnings),
      learning(parts.entity, options.history) {}

std::vector<Candidate> Head::State::candidates(const InterfaceInfo& interface,
                                               const TaskOptions& task,
                                               const SelectionStrategy& strategy, Instant now) {
  auto candidates = known.find(interface, task.only);
  running.note_quarantine(interface, candidates, now);
  if (strategy.reads_history()) learning.predict(interface, task.features, candidates);
  return candidates;
}

std::vector<Candidate> Head::State::await_candidates(const InterfaceInfo& interface,
                                                     const TaskOptions& task,
                                                     const SelectionStrategy& strategy,
                                                     Instant deadline) {
  const entity::LostCsps none(task.only);
  for (;;) {
    const std::uint64_t seen = parts.broker.generation();
    auto found = candidates(interface, task, strategy, parts.clock.now());
    if (!found.empty() || !await_change(interface, none, seen, deadline)) return found;
  }
}

bool Head::State::await_change(const InterfaceInfo& interface, const entity::LostCsps& lost,
                               std::uint64_t seen, Instant deadline) const {
  const auto& broker = parts.broker;
  const CallContext* context = CallContext::current();
  for (;;) {
    const Instant now = parts.clock.now();
    const Instant end = std::min(
        deadline, lost.awaited(broker.absent(interface.name),
                               [&](const Guid& provider) { return broker.knows(provider); }));
    if (now >= end || (context && context->cancelled())) return false;
    if (broker.await_change(seen, std::min(end, now + Duration(kLookPeriod)))) return true;
  }
}

void Head::State::end(const InterfaceInfo& interface, const Candidate& candidate,
                      const std::shared_ptr<const Features>& features, std::uint64_t run,
                      const entity::RunEnding& ending) {
  const bool timed_out = ending.outcome == introspection::Outcome::TimedOut;
  const bool is_told = timed_out && ending.fault && ending.expected > Duration::zero() &&
                       !candidate.in_process && options.on_hang;
  running.end(interface, candidate, run, ending, is_told);
  learning.add(interface, candidate, features, ending);
  if (timed_out && candidate.in_process) overdue.add(interface, candidate, ending.fault);
  if (is_told) options.on_hang(candidate);
}

void Head::State::conclude(introspection::Decision&& record, introspection::Decision* wanted) {
  const bool explored = std::any_of(record.attempts.begin(), record.attempts.end(),
                                    [](const auto& attempt) { return attempt.explores; });
  record.stuck = static_cast<std::uint32_t>(overdue.count());
  learning.end_request(record.service, explored);
  decisions.add(std::move(record), wanted);
}

}  // namespace skein
