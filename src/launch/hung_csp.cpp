#include "hung_csp.hpp"

#include <algorithm>

#include "skein/brokerless_discovery/broker.hpp"
#include "skein/brokerless_discovery/kill_process.hpp"
#include "skein/brokerless_discovery/process_watch.hpp"
#include "skein/core/log.hpp"
#include "skein/discovery.idl.hpp"

namespace skein::launch {

using brokerless_discovery::ProcessWatch;

void end_hung_csp(Entity& entity, const profile::PeerProfile& peer, const Candidate& hung) {
  const profile::CspProfile* csp = peer.find_csp(hung.name);
  if (!csp || csp->process != profile::CspProcess::Own ||
      csp->rules.restart.policy == profile::RestartPolicy::Never) {
    return;
  }
  const auto all = entity.broker().all();
  const auto found = std::find_if(all.begin(), all.end(), [&](const auto& description) {
    return description->provider == hung.provider.bytes;
  });
  if (found == all.end() || (*found)->host != ProcessWatch::host()) return;
  const std::string& process = (*found)->process;
  const bool only_ours = std::all_of(all.begin(), all.end(), [&](const auto& description) {
    return description->process != process || description->owner == entity.id();
  });
  if (only_ours && brokerless_discovery::kill_process(process)) {
    log(LogLevel::Warning, entity.id(),
        hung.name + " (process " + std::to_string(hung.pid) +
            ") hangs and was killed, for the launcher to start it again");
  }
}

}  // namespace skein::launch
