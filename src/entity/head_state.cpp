#include "head_state.hpp"

#include <algorithm>

#include "head_session.hpp"
#include "skein/brokerless_discovery/process_watch.hpp"
#include "skein/core/call_context.hpp"
#include "skein/core/error.hpp"
#include "skein/core/log.hpp"
#include "skein/discovery.idl.hpp"
#include "skein/idl/type_support.hpp"
#include "skein/introspection.idl.hpp"

namespace skein {
namespace {

using brokerless_discovery::number_attribute;
using brokerless_discovery::ServiceDescription;
using Outcome = Attempt::Outcome;

constexpr std::size_t kKeptDecisions = 64;

}  // namespace

Head::State::State(const Parts& parts_, HeadOptions options_)
    : parts(parts_),
      options(std::move(options_)),
      host(brokerless_discovery::ProcessWatch::host()),
      topic(parts.participant, parts.control) {
  strategies.make(options.strategy);
  if (!options.history.empty()) history = History::load(options.history);
  if (options.log.empty()) return;
  log_file.open(options.log, std::ios::app | std::ios::binary);
  if (!log_file) {
    throw InvalidArgument("the Head of " + parts.entity + " cannot write its decisions to '" +
                          options.log + "'; name a file in a folder that may be written to");
  }
}

std::shared_ptr<const SelectionStrategy> Head::State::strategy() const {
  if (const CallContext* context = CallContext::current()) {
    if (const auto* session = dynamic_cast<const HeadSession*>(context->session()))
      return session->strategy;
  }
  std::lock_guard lock(mutex);
  return strategies.make(options.strategy);
}

Candidate Head::State::candidate_of(const InterfaceInfo& interface,
                                    const ServiceDescription& description, bool in_process,
                                    const Features& features, Instant now) const {
  Candidate candidate;
  candidate.name = description.entity;
  candidate.provider = {description.provider};
  candidate.in_process = in_process;
  candidate.pid = description.pid;
  candidate.quality = number_attribute(description, "quality").value_or(0);
  if (const auto latency_ms = number_attribute(description, "latency")) {
    candidate.latency = std::chrono::duration_cast<Duration>(
        std::chrono::duration<double, std::milli>(*latency_ms));
  }
  const std::string service(interface.name);
  candidate.learned = history.predict(service, candidate.name, features);
  if (const auto found = breakers.find({service, candidate.name}); found != breakers.end()) {
    candidate.breaker = found->second.state(now);
    candidate.quarantine = found->second.quarantine(now);
  }
  return candidate;
}

std::vector<Candidate> Head::State::candidates(const InterfaceInfo& interface,
                                               const std::string& only, const Features& features) {
  auto query = parts.broker.query(std::string(interface.name));
  query.client = &interface;
  const Instant now = parts.clock.now();
  std::vector<Candidate> candidates;
  const auto found = parts.broker.find_service(query);
  std::lock_guard lock(mutex);
  for (const auto& description : found) {
    if (!only.empty() && description->entity != only) continue;
    const auto local = parts.directory->find({description->provider});
    // An instance that overran its time is never entered again before it has come back.
    if (local && local->overdue()) continue;
    candidates.push_back(candidate_of(interface, *description, local != nullptr, features, now));
  }
  return candidates;
}

void Head::State::refuse_without(const InterfaceInfo& interface, const std::string& only) const {
  auto query = parts.broker.query(std::string(interface.name));
  query.client = &interface;
  throw NoCandidate(only.empty() ? parts.broker.explain(query)
                                 : "the planner or other CSP '" + only +
                                       "' does not stand by for " + std::string(interface.name));
}

Situation Head::State::situation(const InterfaceInfo& interface, const Features& features,
                                 Duration remaining) const {
  std::lock_guard lock(mutex);
  return {features, remaining, options.exploration, history.decisions(std::string(interface.name))};
}

std::shared_ptr<Channel> Head::State::channel_to(const Candidate& candidate, Duration timeout) {
  {
    std::lock_guard lock(mutex);
    std::erase_if(channels, [](const auto& entry) { return !entry.second->connected(); });
    if (const auto found = channels.find(candidate.provider); found != channels.end())
      return found->second;
  }
  for (const auto& description : parts.broker.all()) {
    if (description->provider != candidate.provider.bytes) continue;
    auto channel = parts.connector.open_provider(*description, {}, timeout);
    std::lock_guard lock(mutex);
    return channels.insert_or_assign(candidate.provider, std::move(channel)).first->second;
  }
  throw Unavailable(candidate.name + " left before it could be asked");
}

CircuitBreaker& Head::State::breaker(const InterfaceInfo& interface, const Candidate& candidate) {
  return breakers.try_emplace({std::string(interface.name), candidate.name}, options.breaker)
      .first->second;
}

bool Head::State::begin(const InterfaceInfo& interface, const Candidate& candidate,
                        std::uint64_t& run) {
  const Instant now = parts.clock.now();
  std::lock_guard lock(mutex);
  CircuitBreaker& breaker = this->breaker(interface, candidate);
  // Listed as open it is the last resort.
  if (breaker.state(now) == CircuitBreaker::State::Open &&
      candidate.breaker != CircuitBreaker::State::Open) {
    return false;
  }
  breaker.begin(now);
  run = ++last_run;
  running[run] = {candidate.name, candidate.pid, host};
  return true;
}

void Head::State::end(const InterfaceInfo& interface, const Candidate& candidate,
                      const Features& features, std::uint64_t run, const Attempt& attempt,
                      bool fault) {
  {
    std::lock_guard lock(mutex);
    running.erase(run);
    CircuitBreaker& breaker = this->breaker(interface, candidate);
    if (fault) {
      breaker.fail(parts.clock.now());
    } else if (attempt.outcome == Outcome::Accepted || attempt.outcome == Outcome::Refused) {
      breaker.succeed();
    } else {
      breaker.end();
    }
    learn(interface, candidate, features, attempt);
    if (attempt.outcome == Outcome::TimedOut && candidate.in_process)
      hung.insert(candidate.provider);
  }
  if (attempt.outcome == Outcome::TimedOut && fault && !candidate.in_process && options.on_hang) {
    options.on_hang(candidate);
  }
}

void Head::State::learn(const InterfaceInfo& interface, const Candidate& candidate,
                        const Features& features, const Attempt& attempt) {
  const bool overran = attempt.expected > Duration::zero() && attempt.took > attempt.expected;
  const bool late =
      attempt.outcome == Outcome::TimedOut || (attempt.outcome == Outcome::Cancelled && overran);
  if (attempt.outcome == Outcome::Cancelled && !late) return;
  history.add(
      std::string(interface.name), candidate.name,
      {features, attempt.took, attempt.outcome == Outcome::Accepted, late, attempt.quality});
}

std::size_t Head::State::count_stuck() {
  std::lock_guard lock(mutex);
  std::erase_if(hung, [&](const Guid& provider) {
    const auto service = parts.directory->find(provider);
    return !service || !service->overdue();
  });
  const bool degraded = hung.size() >= options.most_stuck;
  if (degraded && !was_degraded) {
    log(LogLevel::Error, parts.entity,
        std::to_string(hung.size()) +
            " CSPs in this process do not return; it should be restarted");
  }
  was_degraded = degraded;
  return hung.size();
}

void Head::State::conclude(DecisionRecord& record) {
  record.stuck = count_stuck();
  const bool explored = std::any_of(record.attempts.begin(), record.attempts.end(),
                                    [](const Attempt& attempt) { return attempt.explores; });
  {
    std::lock_guard lock(mutex);
    history.count(record.interface, explored);
    record.number = ++last_decision;
    decisions.push_back(record);
    if (decisions.size() > kKeptDecisions) decisions.pop_front();
  }
  topic.tell(record);
  if (!options.log.empty()) write_log(record);
}

void Head::State::write_log(const DecisionRecord& record) {
  const std::string line = idl::to_json(report_of(record));
  std::lock_guard lock(log_mutex);
  log_file << line << std::endl;
  if (log_file) return;
  log_file.clear();
  log(LogLevel::Warning, parts.entity, "a decision could not be written to '" + options.log + "'");
}

}  // namespace skein
