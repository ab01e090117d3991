#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "brokerless_discovery/broker.hpp"
#include "brokerless_discovery/versions.hpp"
#include "core/log.hpp"
#include "core/suggestion.hpp"
#include "head_state.hpp"
#include "rpc/service/local_directory.hpp"
#include "skein/call_context.hpp"
#include "skein/constraint.hpp"
#include "skein/discovery.idl.hpp"
#include "skein/error.hpp"

namespace skein {

using brokerless_discovery::Absence;
using brokerless_discovery::find_attribute;
using brokerless_discovery::number_attribute;
using brokerless_discovery::Quantity;
using brokerless_discovery::quantity_of;
using brokerless_discovery::ServiceDescription;

namespace {

// Nobody tells a Head that waits that its caller has given up.
constexpr std::chrono::milliseconds kLookPeriod{100};

// What others declare may be any number; as far as any task is concerned, this is for ever.
constexpr double kLongestLatencySeconds = 365.0 * 24 * 3600;

// A plain number is in milliseconds, the dictionary's unit.
std::optional<Duration> declared_latency(const ServiceDescription& description) {
  const std::string* const declared = find_attribute(description, "latency");
  const Quantity quantity = declared ? quantity_of(*declared) : Quantity{};
  if (quantity.kind == Quantity::Kind::Text) return std::nullopt;
  const double seconds =
      quantity.kind == Quantity::Kind::Time ? quantity.value : quantity.value / 1000;
  return std::chrono::round<Duration>(
      std::chrono::duration<double>(std::clamp(seconds, 0.0, kLongestLatencySeconds)));
}

}  // namespace

Head::State::Known Head::State::known(const InterfaceInfo& interface,
                                      const std::shared_ptr<const ServiceDescription>& described) {
  const ServiceDescription& description = *described;
  Known known;
  Candidate& candidate = known.candidate;
  candidate.name = description.entity;
  candidate.provider = {description.provider};
  const auto service = parts.directory->find(candidate.provider);
  known.service = service;
  known.host = std::shared_ptr<const std::string>(described, &description.host);
  candidate.in_process = service != nullptr;
  candidate.pid = description.pid;
  candidate.quality = number_attribute(description, "quality").value_or(0);
  if (!std::isfinite(candidate.quality)) candidate.quality = 0;  // as if it were not declared
  candidate.latency = declared_latency(description);
  known.breaker = &breaker(interface.name, candidate.name);
  return known;
}

bool Head::State::Known::hangs() const {
  const auto instance = service.lock();
  return instance && instance->overdue();
}

// Under the lock. Of what was given to this entity and is never a candidate, each once.
void Head::State::tell_unusable(brokerless_discovery::Query query, std::size_t usable) {
  const InterfaceInfo& interface = *query.client;
  query.client = nullptr;
  const auto all = parts.broker.find_service(query);
  if (all.size() == usable) return;
  for (const auto& description : all) {
    if (brokerless_discovery::understands(interface, *description)) continue;
    const Guid provider{description->provider};
    const bool told = told_unusable.erase(provider);
    told_unusable.insert(provider);
    if (told) continue;
    log(LogLevel::Warning, parts.entity,
        "CSP '" + description->entity + "' is never chosen for " + std::string(interface.name) +
            ", since it holds another version of it: " +
            parts.broker.difference(interface, *description) +
            "; build both sides from the same IDL");
  }
}

// Under the lock. The Broker is asked again once its table has changed.
const Head::State::Roster& Head::State::roster(const InterfaceInfo& interface) {
  Roster& roster = rosters[&interface];
  const std::uint64_t generation = parts.broker.generation();
  if (roster.generation == generation) return roster;
  auto query = parts.broker.query(std::string(interface.name));
  query.client = &interface;
  const auto found = parts.broker.find_service(query);
  roster.csps.clear();
  for (const auto& description : found) roster.csps.push_back(known(interface, description));
  roster.generation = generation;
  tell_unusable(std::move(query), found.size());
  return roster;
}

// Under the lock.
std::shared_ptr<const std::string> Head::State::host_of(const InterfaceInfo& interface,
                                                        const Guid& provider) const {
  const auto roster = rosters.find(&interface);
  if (roster == rosters.end()) return nullptr;
  for (const Known& known : roster->second.csps) {
    if (known.candidate.provider == provider) return known.host;
  }
  return nullptr;
}

std::vector<Candidate> Head::State::candidates(const InterfaceInfo& interface,
                                               const TaskOptions& task,
                                               const SelectionStrategy& strategy, Instant now) {
  std::vector<Candidate> candidates;
  {
    std::lock_guard lock(mutex);
    const Roster& roster = this->roster(interface);
    candidates.reserve(roster.csps.size());
    for (const Known& known : roster.csps) {
      if (!task.only.empty() && known.candidate.name != task.only) continue;
      if (known.hangs()) continue;
      Candidate& candidate = candidates.emplace_back(known.candidate);
      candidate.breaker = known.breaker->state(now);
      if (candidate.breaker != CircuitBreaker::State::Closed)
        candidate.quarantine = known.breaker->quarantine(now);
    }
  }
  if (strategy.reads_history()) learning.predict(interface, task.features, candidates);
  return candidates;
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

// There may be some that have not returned from an earlier request, and are not to be called again.
void Head::State::refuse_without(const InterfaceInfo& interface, const std::string& only) {
  std::vector<std::string> names;
  std::string hung;
  {
    std::lock_guard lock(mutex);
    for (const Known& known : roster(interface).csps) {
      const std::string& name = known.candidate.name;
      names.push_back(name);
      if ((only.empty() || name == only) && known.hangs())
        hung += (hung.empty() ? "" : ", ") + name;
    }
  }
  const std::string task(interface.name);
  if (!hung.empty()) {
    throw NoCandidate("no CSP is free for " + task + ": " + hung +
                      " has not returned from an earlier request whose time is over; it hangs in "
                      "this process, and is called again once it returns");
  }
  std::string absent;
  for (const Absence& csp : parts.broker.absent(interface.name)) {
    if (only.empty() || csp.entity == only)
      absent += (absent.empty() ? "" : "; ") + in_words(csp, parts.clock.now());
  }
  if (!absent.empty()) throw NoCandidate("no CSP is there for " + task + ": " + absent);
  if (!only.empty()) {
    throw NoCandidate("there is no CSP '" + only + "' for " + task + suggestion(only, names));
  }
  auto query = parts.broker.query(task);
  query.client = &interface;
  throw NoCandidate(parts.broker.explain(query) + "; give " + parts.entity +
                    " a CSP for it, by provide_csp() or by <csp> in the mission profile");
}

}  // namespace skein
