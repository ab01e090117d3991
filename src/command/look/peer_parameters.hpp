#pragma once

#include <string>

#include "brokerless_discovery/table.hpp"
#include "skein/clock.hpp"
#include "skein/live_parameters.idl.hpp"

namespace skein {
class Entity;
}  // namespace skein

// Who tells the parameters of running peers.
namespace skein::command {

/// The services that tell those of the entity of that name, NAME or SYSTEM/NAME; of all entities
/// where it is empty.
brokerless_discovery::Table::Found tellers(Entity& entity, const std::string& name);

/// For one question to such a service, which takes no longer than `within` from now on. Throws as
/// Entity::connect().
launch::ILiveParameters::Proxy connect(Entity& entity, const discovery::ServiceDescription& service,
                                       Duration within);

}  // namespace skein::command
