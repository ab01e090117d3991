#include "known_csps.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <utility>

#include "brokerless_discovery/versions.hpp"
#include "core/log.hpp"
#include "core/suggestion.hpp"
#include "rpc/service/local_directory.hpp"
#include "skein/constraint.hpp"
#include "skein/discovery.idl.hpp"
#include "skein/error.hpp"

namespace skein::entity {

using brokerless_discovery::Absence;
using brokerless_discovery::find_attribute;
using brokerless_discovery::number_attribute;
using brokerless_discovery::Quantity;
using brokerless_discovery::quantity_of;
using brokerless_discovery::ServiceDescription;

namespace {

// A CSP may declare any number; as far as any task is concerned, this is for ever.
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

KnownCsps::Known KnownCsps::known(const std::shared_ptr<const ServiceDescription>& described) {
  const ServiceDescription& description = *described;
  Known known;
  Candidate& candidate = known.candidate;
  candidate.name = description.entity;
  candidate.provider = {description.provider};
  const auto service = parts_.directory->find(candidate.provider);
  known.service = service;
  known.host = std::shared_ptr<const std::string>(described, &description.host);
  candidate.in_process = service != nullptr;
  candidate.pid = description.pid;
  candidate.quality = number_attribute(description, "quality").value_or(0);
  if (!std::isfinite(candidate.quality)) candidate.quality = 0;  // as if it were not declared
  candidate.latency = declared_latency(description);
  return known;
}

bool KnownCsps::Known::hangs() const {
  const auto instance = service.lock();
  return instance && instance->overdue();
}

// Under the lock. Warns once of each CSP that this entity was given and that is never a candidate.
void KnownCsps::tell_unusable(brokerless_discovery::Query query, std::size_t usable) {
  const InterfaceInfo& interface = *query.client;
  query.client = nullptr;
  const auto all = parts_.broker.find_service(query);
  if (all.size() == usable) return;
  for (const auto& description : all) {
    if (brokerless_discovery::understands(interface, *description)) continue;
    const Guid provider{description->provider};
    const bool told = told_unusable_.erase(provider);
    told_unusable_.insert(provider);
    if (told) continue;
    log(LogLevel::Warning, parts_.entity,
        "CSP '" + description->entity + "' is never chosen for " + std::string(interface.name) +
            ", since it holds another version of it: " +
            parts_.broker.difference(interface, *description) +
            "; build both sides from the same IDL");
  }
}

// Under the lock.
const std::vector<KnownCsps::Known>& KnownCsps::csps(const InterfaceInfo& interface) {
  Csps& csps = csps_[&interface];
  const std::uint64_t generation = parts_.broker.generation();
  if (csps.generation == generation) return csps.known;
  auto query = parts_.broker.query(std::string(interface.name));
  query.client = &interface;
  const auto found = parts_.broker.find_service(query);
  csps.known.clear();
  for (const auto& description : found) csps.known.push_back(known(description));
  csps.generation = generation;
  tell_unusable(std::move(query), found.size());
  return csps.known;
}

std::shared_ptr<const std::string> KnownCsps::host_of(const InterfaceInfo& interface,
                                                      const Guid& provider) const {
  std::lock_guard lock(mutex_);
  const auto csps = csps_.find(&interface);
  if (csps == csps_.end()) return nullptr;
  for (const Known& known : csps->second.known) {
    if (known.candidate.provider == provider) return known.host;
  }
  return nullptr;
}

std::vector<Candidate> KnownCsps::find(const InterfaceInfo& interface, const std::string& only) {
  std::lock_guard lock(mutex_);
  const std::vector<Known>& csps = this->csps(interface);
  std::vector<Candidate> found;
  found.reserve(csps.size());
  for (const Known& known : csps) {
    if (!only.empty() && known.candidate.name != only) continue;
    if (!known.hangs()) found.push_back(known.candidate);
  }
  return found;
}

// There may be some that have not returned from an earlier request, and are not to be called again.
void KnownCsps::refuse(const InterfaceInfo& interface, const std::string& only) {
  std::vector<std::string> names;
  std::string hung;
  {
    std::lock_guard lock(mutex_);
    for (const Known& known : csps(interface)) {
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
  for (const Absence& csp : parts_.broker.absent(interface.name)) {
    if (only.empty() || csp.entity == only)
      absent += (absent.empty() ? "" : "; ") + in_words(csp, parts_.clock.now());
  }
  if (!absent.empty()) throw NoCandidate("no CSP is there for " + task + ": " + absent);
  if (!only.empty()) {
    throw NoCandidate("there is no CSP '" + only + "' for " + task + suggestion(only, names));
  }
  auto query = parts_.broker.query(task);
  query.client = &interface;
  throw NoCandidate(parts_.broker.explain(query) + "; give " + parts_.entity +
                    " a CSP for it, by provide_csp() or by <csp> in the mission profile");
}

}  // namespace skein::entity
