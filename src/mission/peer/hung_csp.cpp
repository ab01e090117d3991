#include "hung_csp.hpp"

#include <algorithm>

#include "brokerless_discovery/broker.hpp"
#include "brokerless_discovery/kill_process.hpp"
#include "brokerless_discovery/process_watch.hpp"
#include "core/log.hpp"
#include "core/system/interface_name.hpp"
#include "skein/discovery.idl.hpp"
#include "skein/selection.hpp"

namespace skein::launch {

using brokerless_discovery::ProcessWatch;

namespace {

bool is_restarted(const profile::PeerProfile& peer, const std::string& name) {
  const profile::CspProfile* csp = peer.find_csp(name);
  return csp && csp->process == profile::CspProcess::Own &&
         csp->rules.restart.policy != profile::RestartPolicy::Never;
}

void tell(const Entity& entity, const std::string& csp, std::uint32_t process, const char* why) {
  log(LogLevel::Warning, entity.id(),
      csp + " (process " + std::to_string(process) + ") " + why +
          " and was killed, for the launcher to start it again");
}

}  // namespace

void end_hung_csp(Entity& entity, const profile::PeerProfile& peer, const Candidate& hung) {
  if (!is_restarted(peer, hung.name)) return;
  const auto all = entity.broker().all();
  const auto found = std::find_if(all.begin(), all.end(), [&](const auto& description) {
    return description->provider == hung.provider.bytes;
  });
  if (found == all.end() || (*found)->host != ProcessWatch::host()) return;
  const auto pid = (*found)->pid;
  // What Skein itself provides there, as its parameters, has no owner.
  const bool only_ours = std::all_of(all.begin(), all.end(), [&](const auto& description) {
    return description->host != ProcessWatch::host() || description->pid != pid ||
           description->owner == entity.id() || is_built_in_interface(description->service);
  });
  if (only_ours && brokerless_discovery::kill_process((*found)->process)) {
    tell(entity, hung.name, hung.pid, "hangs");
  }
}

void end_stopped_csp(Entity& entity, const profile::PeerProfile& peer,
                     const brokerless_discovery::Change& change) {
  using brokerless_discovery::Departure;
  const auto& csp = *change.description;
  if (change.kind != brokerless_discovery::Change::Kind::Removed ||
      change.departure != Departure::Lost || csp.owner != entity.id() ||
      csp.host != ProcessWatch::host() || !is_restarted(peer, csp.entity)) {
    return;
  }
  if (brokerless_discovery::kill_stopped_process(csp.process)) {
    tell(entity, csp.entity, csp.pid, "is stopped, was not heard of for its lease");
  }
}

}  // namespace skein::launch
