#include "namesakes.hpp"

#include <cerrno>
#include <csignal>

#include "core/host.hpp"
#include "core/interface_name.hpp"
#include "skein/discovery.idl.hpp"
#include "skein/inspection.idl.hpp"

namespace skein::launch {
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
  return tell(service.host, service.pid, here);
}

std::string Namesakes::look_at(const inspection::Answer& answer) {
  if (answer.entity != system_ + "/" + entity_ || answer.peer.empty()) return {};
  const inspection::Peer& peer = answer.peer.front();
  const bool here = peer.host == name_of_this_host();
  if (here && peer.pid == process_) return {};
  return tell(here ? host_ : peer.host, peer.pid, here);
}

std::string Namesakes::tell(const std::string& host, std::uint32_t process, bool here) {
  if (!told_.insert({host, process}).second) return {};
  return "process " + std::to_string(process) + (here ? "" : " on another host") +
         " runs a peer of the same name: callers are served by either of them; end one, or give it "
         "another name or system";
}

}  // namespace skein::launch
