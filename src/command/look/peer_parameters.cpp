#include "peer_parameters.hpp"

#include <algorithm>

#include "brokerless_discovery/broker.hpp"
#include "service_names.hpp"
#include "skein/discovery.idl.hpp"
#include "skein/entity.hpp"

namespace skein::command {

using launch::ILiveParameters;

brokerless_discovery::Table::Found tellers(Entity& entity, const std::string& name) {
  auto found = entity.broker().all();
  std::erase_if(found, [&](const auto& service) {
    return service->service != ILiveParameters::interface_info().name ||
           (!name.empty() && service->entity != name && entity_name_of(*service) != name);
  });
  return found;
}

ILiveParameters::Proxy connect(Entity& entity, const discovery::ServiceDescription& service,
                               Duration within) {
  const Instant end = entity.clock().now() + within;
  const auto peer = entity.connect<ILiveParameters>({.system = ConnectOptions::kAnySystem,
                                                     .provider = Guid{service.provider},
                                                     .timeout = within});
  return peer.within(std::max(Duration::zero(), end - entity.clock().now()));
}

}  // namespace skein::command
