#include "domain_state.hpp"

#include <algorithm>
#include <set>
#include <tuple>

#include "command/print/figures.hpp"
#include "core/log.hpp"
#include "core/printable.hpp"
#include "skein/decision.hpp"
#include "skein/discovery.idl.hpp"

namespace skein::command::designer {
namespace {

constexpr std::size_t kLongestText = 4096;
constexpr double kSecond = 1e9;
/// One answer may be late.
constexpr int kSilentLooks = 2;

using Entities = std::map<std::string, EntityState>;

/// Where a provider's service stands in the drawing.
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
std::string home_of(const PeerPicture& peer, const DomainPicture& picture) {
  for (const auto& service : peer.services) {
    if (!service->owner.empty()) return service->owner;
  }
  const std::string owner = peer.name.substr(0, peer.name.find_last_of('.'));
  const bool stands_alone = std::ranges::count(picture, owner, &PeerPicture::name) == 0;
  return stands_alone ? peer.name : owner;
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

Draft draft_of(const DomainPicture& picture, const std::vector<top::PeerRow>& rows) {
  Draft draft;
  for (std::size_t i = 0; i < picture.size(); ++i) {
    const PeerPicture& peer = picture[i];
    const std::string home = home_of(peer, picture);
    draft.homes[peer.participant] = home;
    EntityState& entity = entity_named(home, draft.entities);
    const bool own = home == peer.name;
    if (own) add_process(peer, rows[i], entity);
    for (const auto& service : peer.services) {
      ServiceState state;
      state.name = printable(service->service);
      state.state = "ready";
      if (!service->owner.empty()) state.csp = printable(service->entity);
      if (!own) state.pid = rows[i].pid;
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
    services.back().csp = printable(service.entity);
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
    state->waiting = row.waiting;
    state->running = row.running;
    state->p50 = row.p50;
    state->p99 = row.p99;
  }
}

/// Calls of one entity to a provider over one transport, or values that it publishes on a topic.
struct Traffic {
  Link link;
  std::uint64_t count = 0;
};
using Traffics = std::map<std::string, Traffic>;

void add_calls(const DomainPicture& picture, const Draft& draft, Traffics& traffics) {
  for (const PeerPicture& peer : picture) {
    const std::string& from = draft.homes.at(peer.participant);
    for (const inspection::Connection& connection : peer.connections) {
      const auto place = draft.providers.find(Guid{connection.provider});
      if (place == draft.providers.end() || place->second.entity == from) continue;
      const EntityState& target = draft.entities.at(place->second.entity);
      const ServiceState& service = target.services[place->second.index];
      Traffic& traffic = traffics[from + "\n" + target.name + "\n" + connection.service + "\n" +
                                  connection.transport];
      traffic.count += connection.calls;
      traffic.link = {printable(from),
                      target.name,
                      LinkKind::Calls,
                      service.name,
                      "ready",
                      printable(connection.transport),
                      printable(connection.not_faster, kLongestText),
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

void add_values(const DomainPicture& picture, const Draft& draft, Traffics& traffics) {
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
      Traffic& traffic = traffics[home + "\n" + reader + "\n" + endpoint.name + "\nvalues"];
      traffic.count += endpoint.samples;
      traffic.link = {printable(home),
                      printable(reader),
                      LinkKind::Values,
                      printable(endpoint.name),
                      "ready",
                      "",
                      "",
                      {},
                      0,
                      0};
    }
  });
}

std::string times(std::uint32_t count) {
  return count == 1 ? "once" : std::to_string(count) + " times";
}

/// What a launcher says of a process which is there, or is to be.
void add_launchers_word(const launch::ProcessStatus& process, std::string& state,
                        std::string& reason) {
  const bool seen = state == "ready" || state == "degraded";
  if (process.state != "ready") {
    state = process.state;
    reason = printable(process.reason, kLongestText);
    if (reason.empty() && !process.last_exit.empty())
      reason = "its process ended " + printable(process.last_exit, kLongestText);
  } else if (!seen && state != "silent") {
    state = "missing";
    reason = "its process runs, but nobody is seen of it on this domain";
  } else if (process.restarts > 0 && reason.empty()) {
    reason = "was restarted " + times(process.restarts) + ", last ended " +
             printable(process.last_exit, kLongestText);
  }
}

/// The entity that a launcher's process is, by the name that the profile gives it.
EntityState& entity_of_process(const std::string& peer, const launch::MissionStatus& mission,
                               Entities& entities) {
  std::set<std::string> systems;
  for (auto& [name, entity] : entities) {
    if (after_slash(name) == peer) return entity;
    systems.insert(before_slash(name));
  }
  const std::string system = systems.size() == 1 ? *systems.begin() : mission.mission;
  return entity_named(system + "/" + peer, entities);
}

ServiceState& csp_named(const std::string& csp, EntityState& entity) {
  const auto found = std::ranges::find(entity.services, csp, &ServiceState::csp);
  if (found != entity.services.end()) return *found;
  entity.services.emplace_back();
  entity.services.back().csp = printable(csp);
  return entity.services.back();
}

void add_missions(const std::vector<launch::MissionStatus>& missions, Entities& entities) {
  for (const auto& mission : missions) {
    for (const auto& process : mission.processes) {
      EntityState& entity = entity_of_process(before_slash(process.name), mission, entities);
      entity.launcher = mission.launcher;
      if (process.name.find('/') == std::string::npos) {
        entity.process = process.name;
        add_launchers_word(process, entity.state, entity.reason);
      } else {
        ServiceState& csp = csp_named(after_slash(process.name), entity);
        csp.process = process.name;
        csp.pid = process.pid;
        add_launchers_word(process, csp.state, csp.reason);
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

/// What the plan has and nobody has seen, and what is there without being planned.
void add_plan(const Plan& plan, Entities& entities) {
  std::set<std::string> planned;
  for (const Plan::Entity& wanted : plan.entities) {
    planned.insert(wanted.name);
    EntityState& entity = entity_named(wanted.name, entities);
    if (entity.state.empty()) {
      entity.state = "missing";
      entity.reason = "the plan has it, and nobody of this name is on this domain";
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
  for (auto& [name, entity] : entities) {
    if (planned.contains(name) || entity.state != "ready") continue;
    entity.state = "unplanned";
    entity.reason = "the plan does not have it";
  }
}

void add_planned_links(const Plan& plan, std::vector<Link>& links) {
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
        links.push_back({client.name,
                         server.name,
                         LinkKind::Calls,
                         interface,
                         "missing",
                         "",
                         "the plan has it, and there is no connection",
                         {},
                         0,
                         0});
      }
    }
  }
}

void add_quarantines(const std::vector<introspection::Decision>& decisions, Entities& entities) {
  for (const auto& decision : decisions) {
    const auto entity = entities.find(decision.entity);
    if (entity == entities.end()) continue;
    for (const auto& candidate : decision.candidates) {
      const auto csp =
          std::ranges::find(entity->second.services, candidate.csp, &ServiceState::csp);
      if (csp == entity->second.services.end() || csp->state != "ready" ||
          candidate.breaker != introspection::BreakerState::Open)
        continue;
      csp->state = "quarantined";
      csp->reason =
          "it failed again and again, and is tried again in " +
          short_time(static_cast<std::uint64_t>(std::max<std::int64_t>(candidate.quarantine, 0)));
    }
  }
}

}  // namespace

DomainState StateMaker::make(const Sight& sight) {
  Draft draft = draft_of(sight.picture, rates_.peers(sight.picture));
  add_statistics(sight.statistics, rates_.services(sight.statistics, sight.time), draft);
  Traffics traffics;
  add_calls(sight.picture, draft, traffics);
  add_values(sight.picture, draft, traffics);
  DomainState state;
  const double seconds =
      time_before_ == 0 ? 0 : static_cast<double>(sight.time - time_before_) / kSecond;
  std::map<std::string, std::uint64_t> counts;
  for (auto& [key, traffic] : traffics) {
    counts[key] = traffic.count;
    const auto before = counts_before_.find(key);
    if (seconds > 0 && before != counts_before_.end() && before->second <= traffic.count)
      traffic.link.rate.push_back(static_cast<double>(traffic.count - before->second) / seconds);
    state.links.push_back(std::move(traffic.link));
  }
  counts_before_ = std::move(counts);
  time_before_ = sight.time;
  if (plan_) {
    for (const Plan::Entity& wanted : plan_->entities) entity_named(wanted.name, draft.entities);
    add_planned_links(*plan_, state.links);
  }
  add_missions(sight.missions, draft.entities);
  remember(sight.time, draft.entities);
  if (plan_) add_plan(*plan_, draft.entities);
  add_quarantines(sight.decisions, draft.entities);
  for (auto& [name, entity] : draft.entities) {
    std::ranges::stable_sort(entity.services, {}, [](const ServiceState& service) {
      return std::tuple(!service.csp.empty(), service.name, service.csp);
    });
    state.entities.push_back(std::move(entity));
  }
  return state;
}

void StateMaker::remember(std::uint64_t now, Entities& entities) {
  for (auto& [name, entity] : entities) {
    if (entity.state.empty()) continue;  // it was not seen
    Known& known = known_[name];
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
    entity.state = "gone";
    entity.reason = "was last seen " + short_time(now - known.seen) + " ago";
    for (ServiceState& service : entity.services) {
      service.state = "gone";
      service.calls.clear();
    }
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

}  // namespace skein::command::designer
