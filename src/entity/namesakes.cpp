#include "namesakes.hpp"

#include "brokerless_discovery/process_watch.hpp"
#include "core/system/abstract_socket.hpp"
#include "core/system/interface_name.hpp"
#include "skein/discovery.idl.hpp"

namespace skein::entity {
namespace {

/// A process that has ended is known for a while. Its number may be another's by then.
bool has_left(const discovery::ServiceDescription& service) {
  return brokerless_discovery::ProcessWatch::is_address(service.process) &&
         reach(service.process, [](uid_t) { return true; }).reached == Reached::Nobody;
}

}  // namespace

std::string Namesakes::look_at(const brokerless_discovery::Change& change) {
  const auto& service = *change.description;
  const bool is_namesake = change.kind == brokerless_discovery::Change::Kind::Added &&
                           service.owner.empty() && service.system == system_ &&
                           service.entity == entity_ && !is_built_in_interface(service.service);
  const bool here = service.host == host_;
  if (!is_namesake || (here && (service.pid == process_ || has_left(service)))) return {};
  if (!told_.insert({service.host, service.pid}).second) return {};
  return "process " + std::to_string(service.pid) + (here ? "" : " on another host") +
         " runs an entity of the same name: callers are served by either of them; end one, or give "
         "it another name or system";
}

}  // namespace skein::entity
