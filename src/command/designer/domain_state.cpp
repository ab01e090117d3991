#include "domain_state.hpp"

#include <algorithm>
#include <set>
#include <tuple>
#include <utility>

#include "command/print/figures.hpp"
#include "core/log.hpp"
#include "core/printable.hpp"
#include "skein/discovery.idl.hpp"
#include "skein/introspection.idl.hpp"
#include "skein/selection.hpp"

namespace skein::command::designer {
namespace {

constexpr std::size_t kLongestText = 4096;
constexpr double kSecond = 1e9;
/// One answer may be late.
constexpr int kSilentLooks = 2;

using Entities = std::map<std::string, EntityState>;

/// The place of a provider's service in the drawing.
struct ServicePlace {
  std::string entity;
  std::size_t index;
};

/// A state in the making.
struct Draft {
  Entities entities;
  std::map<Guid, std::string> homes;  // the entity to which each participant belongs
  std::map<Guid, ServicePlace> providers;
};

std::string after_slash(const std::string& name) { return name.substr(name.find('/') + 1); }
std::string before_slash(const std::string& name) { return name.substr(0, name.find('/')); }

/// A CSP in a process of its own belongs to the entity that may use it.
/// Without a description, as while it starts or hangs, its name tells.
std::string home_of(const PeerPicture& peer, const std::set<std::string>& known) {
  for (const auto& service : peer.services) {
    if (!service->owner.empty()) return service->owner;
  }
  const std::string owner = peer.name.substr(0, peer.name.find_last_of('.'));
  return known.contains(owner) ? owner : peer.name;
}

void add_process(const PeerPicture& peer, const top::PeerRow& row, EntityState& entity) {
  entity.pid = row.pid;
  entity.memory = row.memory;
  entity.threads = row.threads;
  if (row.cpu) entity.cpu.push_back(*row.cpu);
  if (const auto& process = peer.process) {
    entity.host = printable(process->host);
    entity.program = printable(process->program, kLongestText);
    entity.vendor = printable(process->vendor);
    entity.version = printable(process->version);
    entity.state = process->degraded ? "degraded" : "ready";
    if (process->degraded) entity.reason = "a CSP does not return; restart the process";
  } else {
    entity.state = "silent";
    entity.reason = "the Broker knows it, but it does not answer: it hangs, or is far too busy";
  }
}

EntityState& entity_named(const std::string& name, Entities& entities) {
  EntityState& entity = entities[name];
  entity.name = printable(name);
  entity.system = printable(before_slash(name));
  return entity;
}

void add_csp_process(const PeerPicture& peer, const top::PeerRow& row, ServiceState& csp) {
  csp.pid = row.pid;
  if (row.cpu) csp.cpu.push_back(*row.cpu);
  if (peer.process) return;
  csp.state = "silent";
  csp.reason = "its process does not answer";
}

Draft draft_of(const DomainPicture& picture, const std::vector<top::PeerRow>& rows,
               const std::set<std::string>& known) {
  Draft draft;
  for (std::size_t i = 0; i < picture.size(); ++i) {
    const PeerPicture& peer = picture[i];
    const std::string home = home_of(peer, known);
    draft.homes[peer.participant] = home;
    EntityState& entity = entity_named(home, draft.entities);
    const bool own = home == peer.name;
    if (own) add_process(peer, rows[i], entity);
    for (const auto& service : peer.services) {
      ServiceState state;
      state.name = printable(service->service);
      state.state = "ready";
      if (!service->owner.empty()) state.csp = printable(service->entity);
      if (!own) add_csp_process(peer, rows[i], state);
      draft.providers[Guid{service->provider}] = {home, entity.services.size()};
      entity.services.push_back(std::move(state));
    }
  }
  return draft;
}

/// CSPs in their entity's process are known by their statistics alone.
ServiceState* service_of(const introspection::ServiceStatistics& service, Draft& draft) {
  const Guid provider{service.provider};
  auto place = draft.providers.find(provider);
  if (place == draft.providers.end()) {
    const auto home = draft.homes.find(provider.participant());
    if (home == draft.homes.end()) return nullptr;
    auto& services = draft.entities[home->second].services;
    place = draft.providers.emplace(provider, ServicePlace{home->second, services.size()}).first;
    services.emplace_back();
    services.back().name = printable(service.service);
    const bool is_csp = service.entity != after_slash(home->second);
    if (is_csp) services.back().csp = printable(service.entity);
    services.back().state = "ready";
  }
  return &draft.entities[place->second.entity].services[place->second.index];
}

void add_statistics(const std::vector<introspection::ServiceStatistics>& statistics,
                    const std::vector<top::ServiceRow>& rows, Draft& draft) {
  for (std::size_t i = 0; i < statistics.size(); ++i) {
    ServiceState* const state = service_of(statistics[i], draft);
    if (!state) continue;
    const top::ServiceRow& row = rows[i];
    if (row.calls) state->calls.push_back(*row.calls);
    if (row.failed) state->failed.push_back(*row.failed);
    for (const auto& operation : statistics[i].operations) state->total += operation.received;
    state->waiting = row.waiting;
    state->running = row.running;
    state->p50 = row.p50;
    state->p99 = row.p99;
  }
}

/// Calls of one entity to a provider over one transport, or values that it publishes on a topic.
struct CountedLink {
  Link link;
  std::uint64_t count = 0;
};
using CountedLinks = std::map<std::string, CountedLink>;

void add_calls(const DomainPicture& picture, const Draft& draft, CountedLinks& counted) {
  for (const PeerPicture& peer : picture) {
    const std::string& from = draft.homes.at(peer.participant);
    for (const inspection::Connection& connection : peer.connections) {
      const auto place = draft.providers.find(Guid{connection.provider});
      if (place == draft.providers.end() || place->second.entity == from) continue;
      const EntityState& target = draft.entities.at(place->second.entity);
      const ServiceState& service = target.services[place->second.index];
      CountedLink& carried = counted[from + "\n" + target.name + "\n" + connection.service + "\n" +
                                     connection.transport];
      carried.count += connection.calls;
      carried.link = {printable(from),
                      target.name,
                      LinkKind::Calls,
                      service.name,
                      "ready",
                      printable(connection.transport),
                      printable(connection.not_faster, kLongestText),
                      0,
                      {},
                      service.p50,
                      service.p99};
    }
  }
}

/// A topic of a system is another one than that of the same name elsewhere.
using TopicKey = std::tuple<std::string, std::string, std::string>;

std::vector<TopicKey> keys_of(const inspection::TopicEndpoint& endpoint, const std::string& home) {
  std::vector<TopicKey> keys;
  for (const std::string& system : endpoint.systems)
    keys.emplace_back(system, endpoint.name, endpoint.type);
  if (keys.empty()) keys.emplace_back(before_slash(home), endpoint.name, endpoint.type);
  return keys;
}

void add_values(const DomainPicture& picture, const Draft& draft, CountedLinks& counted) {
  std::map<TopicKey, std::set<std::string>> readers;
  const auto for_each = [&](bool publishers, const auto& visit) {
    for (const PeerPicture& peer : picture) {
      const std::string& home = draft.homes.at(peer.participant);
      for (const inspection::TopicEndpoint& endpoint : peer.topics) {
        if (endpoint.publishes != publishers) continue;
        for (const TopicKey& key : keys_of(endpoint, home)) visit(home, endpoint, key);
      }
    }
  };
  for_each(false, [&](const std::string& home, const auto&, const TopicKey& key) {
    readers[key].insert(home);
  });
  for_each(true, [&](const std::string& home, const auto& endpoint, const TopicKey& key) {
    for (const std::string& reader : readers[key]) {
      if (reader == home) continue;
      CountedLink& carried = counted[home + "\n" + reader + "\n" + endpoint.name + "\nvalues"];
      carried.count += endpoint.samples;
      carried.link = {printable(home),
                      printable(reader),
                      LinkKind::Values,
                      printable(endpoint.name),
                      "ready",
                      "",
                      "",
                      0,
                      {},
                      0,
                      0};
    }
  });
}

std::string times(std::uint32_t count) {
  return count == 1 ? "once" : std::to_string(count) + " times";
}

/// Adds the launcher's state of a process.
void add_launchers_word(const launch::ProcessStatus& process, bool is_stopped, std::string& state,
                        std::string& reason) {
  const bool seen = state == "ready" || state == "degraded" || state == "silent";
  if (process.state != "ready") {
    state = process.state;
    reason = printable(process.reason, kLongestText);
    if (state == "interrupted" || state == "terminated")
      reason = "it was told to end, and has not ended yet";
    if (reason.empty() && !process.last_exit.empty())
      reason = "its process ended " + printable(process.last_exit, kLongestText);
  } else if (is_stopped) {
    state = "hangs";
    reason = "its process is stopped, and answers nobody; restart it";
  } else if (!seen) {
    state = "missing";
    reason = "its process runs, but nobody is seen of it on this domain";
  } else if (process.restarts > 0 && reason.empty()) {
    reason = "was restarted " + times(process.restarts) + ", last ended " +
             printable(process.last_exit, kLongestText);
  }
}

ServiceState& csp_named(const std::string& csp, EntityState& entity) {
  const auto found = std::ranges::find(entity.services, csp, &ServiceState::csp);
  if (found != entity.services.end()) return *found;
  entity.services.emplace_back();
  entity.services.back().csp = printable(csp);
  return entity.services.back();
}

void add_missions(const Observation& sight, Entities& entities) {
  for (const auto& mission : sight.missions) {
    if (mission.launcher == 0) continue;  // it has ended
    for (const auto& process : mission.processes) {
      EntityState& entity =
          entity_named(process.system + "/" + before_slash(process.name), entities);
      const bool is_stopped = process.pid != 0 && sight.stopped.contains(process.pid);
      entity.launcher = mission.launcher;
      if (process.name.find('/') == std::string::npos) {
        entity.process = process.name;
        add_launchers_word(process, is_stopped, entity.state, entity.reason);
      } else {
        ServiceState& csp = csp_named(after_slash(process.name), entity);
        csp.process = process.name;
        csp.pid = process.pid;
        add_launchers_word(process, is_stopped, csp.state, csp.reason);
      }
    }
  }
}

bool has_service(const Plan::Service& wanted, const EntityState& entity) {
  return std::ranges::any_of(entity.services, [&](const ServiceState& each) {
    return wanted.csp.empty() ? each.csp.empty() && each.name == wanted.name
                              : each.csp == wanted.csp;
  });
}

void mark_unplanned(std::string& state, std::string& reason) {
  if (state == "ready") {
    state = "unplanned";
    reason = "the plan does not have it";
  } else if (state != "missing") {
    reason += (reason.empty() ? "" : "; ") + std::string("the plan does not have it");
  }
}

void add_planned_services(const Plan::Entity& wanted, EntityState& entity) {
  for (ServiceState& service : entity.services) {
    const bool is_planned = std::ranges::any_of(wanted.services, [&](const auto& each) {
      return each.csp == service.csp && (!each.csp.empty() || each.name == service.name);
    });
    if (!is_planned) mark_unplanned(service.state, service.reason);
  }
  for (const Plan::Service& service : wanted.services) {
    if (has_service(service, entity)) continue;
    ServiceState state;
    state.name = service.name;
    state.csp = service.csp;
    state.process = service.process;
    state.state = "missing";
    state.reason = "the plan has it, and the entity does not";
    entity.services.push_back(std::move(state));
  }
}

/// Marks entities and services that are missing, and those that are not planned.
void add_plan(const Plan& plan, Entities& entities) {
  std::set<std::string> planned;
  for (const Plan::Entity& wanted : plan.entities) {
    planned.insert(wanted.name);
    EntityState& entity = entity_named(wanted.name, entities);
    if (entity.state.empty()) {
      entity.state = "missing";
      entity.reason = "the plan has it, and nobody of this name is on this domain";
    }
    add_planned_services(wanted, entity);
  }
  for (auto& [name, entity] : entities)
    if (!planned.contains(name)) mark_unplanned(entity.state, entity.reason);
}

void forget_process(const std::string& state, ServiceState& service) {
  service.state = state;
  service.reason.clear();
  service.process.clear();
  service.pid = 0;
  service.cpu.clear();
  service.calls.clear();
}

/// Of an entity of which nobody is seen at the moment.
void keep_services(const EntityState& before, EntityState& entity) {
  for (const ServiceState& service : before.services) {
    const auto now = std::ranges::find_if(entity.services, [&](const ServiceState& each) {
      return each.csp == service.csp && (!service.csp.empty() || each.name == service.name);
    });
    if (now != entity.services.end()) {
      now->name = service.name;  // which a launcher does not know
    } else {
      entity.services.push_back(service);
      forget_process("missing", entity.services.back());
    }
  }
}

bool is_away(const EntityState& entity) {
  return entity.state == "missing" || entity.state == "gone" || entity.state == "ended";
}

void add_planned_links(const Plan& plan, const Entities& entities, std::vector<Link>& links) {
  const auto is_there = [&](const std::string& from, const std::string& to,
                            const std::string& interface) {
    return std::ranges::any_of(links, [&](const Link& link) {
      return link.source == from && link.target == to && link.name == interface;
    });
  };
  for (const Plan::Entity& client : plan.entities) {
    for (const std::string& interface : client.dependencies) {
      for (const Plan::Entity& server : plan.entities) {
        const bool provides = std::ranges::any_of(server.services, [&](const auto& service) {
          return service.csp.empty() && service.name == interface;
        });
        if (!provides || server.name == client.name || server.system != client.system ||
            is_there(client.name, server.name, interface))
          continue;
        const bool away = is_away(entities.at(server.name));
        const char* const reason = away ? "it depends on this, which is not there"
                                        : "it depends on this, and has not connected to it";
        links.push_back({client.name,
                         server.name,
                         LinkKind::Calls,
                         interface,
                         away ? "missing" : "unused",
                         "",
                         reason,
                         0,
                         {},
                         0,
                         0});
      }
    }
  }
}

void add_quarantines(const Observation& sight, Entities& entities) {
  for (const auto& decision : sight.decisions) {
    const auto age = static_cast<std::int64_t>(sight.wall_time - decision.time);
    const auto entity = entities.find(decision.entity);
    if (entity == entities.end()) continue;
    for (const auto& candidate : decision.candidates) {
      const auto csp =
          std::ranges::find(entity->second.services, candidate.csp, &ServiceState::csp);
      if (csp == entity->second.services.end() || csp->state != "ready" ||
          candidate.breaker != introspection::BreakerState::Open || candidate.quarantine <= age)
        continue;
      csp->state = "quarantined";
      csp->reason = "it failed again and again, and is tried again in " +
                    short_time(static_cast<std::uint64_t>(candidate.quarantine - age));
    }
  }
}

}  // namespace

DomainState StateMaker::make(const Observation& sight) {
  Draft draft = draft_of(sight.picture, rates_.peers(sight.picture), names(sight));
  add_statistics(sight.statistics, rates_.services(sight.statistics, sight.time), draft);
  CountedLinks counted;
  add_calls(sight.picture, draft, counted);
  add_values(sight.picture, draft, counted);
  DomainState state;
  const double seconds =
      time_before_ == 0 ? 0 : static_cast<double>(sight.time - time_before_) / kSecond;
  std::map<std::string, std::uint64_t> counts;
  for (auto& [key, carried] : counted) {
    counts[key] = carried.link.total = carried.count;
    const auto before = counts_before_.find(key);
    if (seconds > 0 && before != counts_before_.end() && before->second <= carried.count)
      carried.link.rate.push_back(static_cast<double>(carried.count - before->second) / seconds);
    state.links.push_back(std::move(carried.link));
  }
  counts_before_ = std::move(counts);
  time_before_ = sight.time;
  add_missions(sight, draft.entities);
  remember(sight, draft.entities);
  if (plan_) {
    add_plan(*plan_, draft.entities);
    add_planned_links(*plan_, draft.entities, state.links);
  }
  add_quarantines(sight, draft.entities);
  for (auto& [name, entity] : draft.entities) {
    std::ranges::stable_sort(entity.services, {}, [](const ServiceState& service) {
      return std::tuple(!service.csp.empty(), service.name, service.csp);
    });
    state.entities.push_back(std::move(entity));
  }
  return state;
}

/// Of entities that are or may be there.
std::set<std::string> StateMaker::names(const Observation& sight) const {
  std::set<std::string> names;
  for (const PeerPicture& peer : sight.picture) names.insert(peer.name);
  for (const auto& [name, known] : known_) names.insert(name);
  for (const auto& mission : sight.missions)
    for (const auto& process : mission.processes)
      names.insert(process.system + "/" + before_slash(process.name));
  if (plan_)
    for (const Plan::Entity& wanted : plan_->entities) names.insert(wanted.name);
  return names;
}

void StateMaker::remember(const Observation& sight, Entities& entities) {
  const std::uint64_t now = sight.time;
  for (auto& [name, entity] : entities) {
    Known& known = known_[name];
    if (entity.state.empty()) {
      entity.state = "missing";
      entity.reason = "CSPs of it are there, and nobody else";
    }
    // The others soon forget an entity that hangs, but its services should still be shown.
    if (entity.pid == 0 && known.seen > 0) keep_services(known.state, entity);
    known.silent_looks = entity.state == "silent" ? known.silent_looks + 1 : 0;
    if (known.silent_looks > 0 && known.silent_looks < kSilentLooks)
      std::tie(entity.state, entity.reason) = std::tuple("ready", "");
    known.seen = now;
    known.state = entity;
  }
  std::erase_if(known_, [&](const auto& each) { return now - each.second.seen > kRemembered; });
  for (const auto& [name, known] : known_) {
    if (known.seen == now) continue;
    EntityState& entity = entities[name];
    entity = known.state;
    entity.cpu.clear();
    entity.process.clear();
    const bool ended = std::exchange(entity.launcher, 0) != 0;
    entity.state = ended ? "ended" : "gone";
    entity.reason = (ended ? "its mission has ended; " : "") + std::string("was last seen ") +
                    short_time(now - known.seen) + " ago";
    for (ServiceState& service : entity.services) forget_process(entity.state, service);
  }
}

DecisionNote note_of(const introspection::Decision& decision) {
  DecisionNote note;
  note.entity = printable(decision.entity);
  note.number = decision.number;
  note.time = decision.time;
  note.request = printable(decision.request);
  note.service = printable(decision.service);
  note.took = decision.took;
  note.failure = printable(decision.failure, kLongestText);
  for (const auto& attempt : decision.attempts)
    note.attempts.push_back({printable(attempt.csp), attempt.outcome});
  note.explanation = explain(decision);
  return note;
}

LogNote note_of(const introspection::LogLine& line) {
  return {line.time,
          printable(line.entity),
          line.pid,
          in_words(static_cast<LogLevel>(line.level)),
          printable(line.place),
          printable(line.text, kLongestText)};
}

LogNote note_of(const launch::MissionLine& line, const std::string& mission) {
  std::string entity = line.process.empty() ? mission : line.system + "/" + line.process;
  const auto csp = entity.find('/', line.system.size() + 1);
  if (!line.process.empty() && csp != std::string::npos) entity[csp] = '.';
  return {line.time,
          printable(entity),
          0,
          "info",
          line.printed ? "printed" : "launcher",
          printable(line.text, kLongestText)};
}

}  // namespace skein::command::designer
