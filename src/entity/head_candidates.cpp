#include <algorithm>

#include "head_state.hpp"
#include "skein/core/error.hpp"
#include "skein/discovery.idl.hpp"

namespace skein {

using brokerless_discovery::number_attribute;
using brokerless_discovery::ServiceDescription;

Head::State::Known Head::State::known(const InterfaceInfo& interface,
                                      const ServiceDescription& description) {
  Known known;
  Candidate& candidate = known.candidate;
  candidate.name = description.entity;
  candidate.provider = {description.provider};
  const auto service = parts.directory->find(candidate.provider);
  known.service = service;
  candidate.in_process = service != nullptr;
  candidate.pid = description.pid;
  candidate.quality = number_attribute(description, "quality").value_or(0);
  if (const auto latency_ms = number_attribute(description, "latency")) {
    candidate.latency = std::chrono::duration_cast<Duration>(
        std::chrono::duration<double, std::milli>(*latency_ms));
  }
  known.standing = &standing(interface.name, candidate.name);
  return known;
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
  for (const auto& description : found) roster.csps.push_back(known(interface, *description));
  roster.generation = generation;
  return roster;
}

std::vector<Candidate> Head::State::candidates(const InterfaceInfo& interface,
                                               const std::string& only, const Features& features,
                                               Instant now) {
  std::lock_guard lock(mutex);
  const Roster& roster = this->roster(interface);
  std::vector<Candidate> candidates;
  candidates.reserve(roster.csps.size());
  for (const Known& known : roster.csps) {
    if (!only.empty() && known.candidate.name != only) continue;
    // An instance that overran its time is never entered again before it has come back.
    const auto service = known.service.lock();
    if (service && service->overdue()) continue;
    Candidate& candidate = candidates.emplace_back(known.candidate);
    candidate.learned = history.predict(interface.name, candidate.name, features);
    candidate.breaker = known.standing->breaker.state(now);
    if (candidate.breaker != CircuitBreaker::State::Closed)
      candidate.quarantine = known.standing->breaker.quarantine(now);
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
  return {features, remaining, options.exploration, history.decisions(interface.name)};
}

std::shared_ptr<Channel> Head::State::channel_to(const Candidate& candidate, Duration patience,
                                                 Instant& now) {
  {
    std::lock_guard lock(mutex);
    const auto found = channels.find(candidate.provider);
    if (found != channels.end() && found->second->connected()) return found->second;
    std::erase_if(channels, [](const auto& entry) { return !entry.second->connected(); });
  }
  for (const auto& description : parts.broker.all()) {
    if (description->provider != candidate.provider.bytes) continue;
    auto channel = parts.connector.open_provider(*description, {}, patience);
    now = parts.clock.now();
    std::lock_guard lock(mutex);
    return channels.insert_or_assign(candidate.provider, std::move(channel)).first->second;
  }
  throw Unavailable(candidate.name + " left before it could be asked");
}

}  // namespace skein
