#include "namesakes.hpp"

#include <cerrno>
#include <csignal>

#include "core/system/interface_name.hpp"
#include "skein/discovery.idl.hpp"

namespace skein::entity {
namespace {

/// What a process has left behind is known for a while after its end.
bool lives(std::uint32_t process) {
  return ::kill(static_cast<pid_t>(process), 0) == 0 || errno == EPERM;
}

}  // namespace

std::string Namesakes::look_at(const brokerless_discovery::Change& change) {
  const auto& service = *change.description;
  const bool is_namesake = change.kind == brokerless_discovery::Change::Kind::Added &&
                           service.owner.empty() && service.system == system_ &&
                           service.entity == entity_ && !is_built_in_interface(service.service);
  const bool here = service.host == host_;
  if (!is_namesake || (here && (service.pid == process_ || !lives(service.pid)))) return {};
  if (!told_.insert({service.host, service.pid}).second) return {};
  return "process " + std::to_string(service.pid) + (here ? "" : " on another host") +
         " runs an entity of the same name: callers are served by either of them; end one, or give "
         "it another name or system";
}

}  // namespace skein::entity
