#pragma once

#include <string>
#include <vector>

#include "brokerless_discovery/broker.hpp"

// The names by which people mean services, types and entities.
namespace skein::command {

/// `SYSTEM/ENTITY`, as `skein peers` and `skein services` print it.
std::string entity_name_of(const discovery::ServiceDescription& service);

/// Whether people may mean the entity SYSTEM/ENTITY: by all of it, or by ENTITY.
bool is_entity_named(const std::string& entity, const std::string& name);

/// What the entity of that name, SYSTEM/ENTITY, provides for others, but for services of Skein's.
brokerless_discovery::Table::Found services_of(const brokerless_discovery::Broker& broker,
                                               const std::string& entity);

/// Whether people may mean the service by its interface, its interface's last part, or its entity
/// (whose own services are meant by that, not those of Skein beside them).
bool is_named(const discovery::ServiceDescription& service, const std::string& name);

/// Whether people may mean the interface: `A/I`, `A::I` or `I`.
bool is_interface_named(const std::string& interface, const std::string& name);

/// What to write where one entity provides several services; empty where it provides one.
std::string choice_among(const brokerless_discovery::Table::Found& services);

/// Whether people may mean the type: `boat::Pose`, or `Pose`.
bool is_type_named(const std::string& type, const std::string& name);

}  // namespace skein::command
