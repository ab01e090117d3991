#include <chrono>
#include <cstdio>
#include <set>
#include <string>
#include <thread>

#include "brokerless_discovery/broker.hpp"
#include "command/commands.hpp"
#include "core/printable.hpp"
#include "core/system/interface_name.hpp"
#include "peer_parameters.hpp"
#include "service_names.hpp"
#include "skein/discovery.idl.hpp"
#include "skein/entity.hpp"
#include "skein/inspector.hpp"

namespace skein::command {
namespace {

using Names = std::set<std::string>;

/// Who presses the tab key waits for this.
constexpr std::chrono::milliseconds kListening{600};
constexpr std::chrono::milliseconds kCompletionWithin{500};

bool is_public(const discovery::ServiceDescription& service) {
  return service.owner.empty() && !is_built_in_interface(service.service);
}

Names services(Entity& entity) {
  Names names;
  for (const auto& service : entity.broker().all()) {
    if (is_public(*service))
      names.insert({short_interface_name(service->service), service->entity});
  }
  return names;
}

Names operations(Entity& entity, const std::string& service_name) {
  Names names;
  for (const auto& service : entity.broker().all()) {
    if (!is_public(*service) || !is_named(*service, service_name)) continue;
    for (const auto& operation : service->operations) names.insert(operation.name);
  }
  return names;
}

Names topics(Entity& entity) {
  Names names;
  Inspector inspector(entity);
  for (const KnownTopic& topic : known_topics(inspector, kCompletionWithin))
    names.insert(topic.name);
  return names;
}

/// Of those whose parameters are told.
Names entities(Entity& entity) {
  Names names;
  for (const auto& service : tellers(entity, "")) names.insert(service->entity);
  return names;
}

Names parameters(Entity& entity, const std::string& name) {
  Names names;
  for (const auto& service : tellers(entity, name)) {
    for (const auto& parameter : connect(entity, *service, kCompletionWithin).parameters())
      names.insert(parameter.name);
  }
  return names;
}

Names names_of(Entity& entity, const std::string& kind, const std::string& before) {
  if (kind == "service") return services(entity);
  if (kind == "operation") return operations(entity, before);
  if (kind == "topic") return topics(entity);
  if (kind == "entity") return entities(entity);
  if (kind == "parameter") return parameters(entity, before);
  Names all = services(entity);
  all.merge(topics(entity));
  return all;
}

}  // namespace

int print_live_names(const LiveNamesArguments& arguments) {
  Entity entity = join(arguments, "complete");
  std::this_thread::sleep_for(kListening);
  for (const std::string& name : names_of(entity, arguments.kind, arguments.before))
    std::printf("%s\n", printable(name).c_str());
  return 0;
}

}  // namespace skein::command
