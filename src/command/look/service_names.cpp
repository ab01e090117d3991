#include "service_names.hpp"

#include <algorithm>

#include "core/system/interface_name.hpp"
#include "skein/discovery.idl.hpp"

namespace skein::command {

std::string entity_name_of(const discovery::ServiceDescription& service) {
  return service.system + "/" + service.entity;
}

bool is_entity_named(const std::string& entity, const std::string& name) {
  return entity == name || entity.substr(entity.find('/') + 1) == name;
}

brokerless_discovery::Table::Found services_of(const brokerless_discovery::Broker& broker,
                                               const std::string& entity) {
  auto services = broker.all();
  std::erase_if(services, [&](const auto& service) {
    return !service->owner.empty() || is_built_in_interface(service->service) ||
           entity_name_of(*service) != entity;
  });
  return services;
}

bool is_named(const discovery::ServiceDescription& service, const std::string& name) {
  if (is_interface_named(service.service, name)) return true;
  return !is_built_in_interface(service.service) &&
         (service.entity == name || entity_name_of(service) == name);
}

bool is_interface_named(const std::string& interface, const std::string& name) {
  if (!is_interface_name(name)) return false;
  return canonical_interface_name(name) == interface || name == short_interface_name(interface);
}

std::string choice_among(const brokerless_discovery::Table::Found& services) {
  if (services.size() < 2) return {};
  std::string list;
  for (const auto& service : services)
    list += (list.empty() ? "" : ", ") + scoped_interface_name(service->service);
  return entity_name_of(*services.front()) + " provides " + list +
         "; name one of them, with --system " + services.front()->system;
}

bool is_type_named(const std::string& type, const std::string& name) {
  return type == name || (type.ends_with("::" + name) && !name.empty());
}

}  // namespace skein::command
