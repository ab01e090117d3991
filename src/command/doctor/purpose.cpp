#include "purpose.hpp"

#include <algorithm>

#include "dds/port/vendor_names.hpp"
#include "mission/supervise/launch_plan.hpp"

namespace skein::command::doctor {
namespace {

void add(std::vector<std::string>& words, const std::string& word) {
  if (!word.empty() && std::ranges::count(words, word) == 0) words.push_back(word);
}

void add_threads(Purpose& purpose, const profile::ThreadRules& threads) {
  using Scheduling = ThreadSettings::Scheduling;
  if (threads.settings.scheduling != Scheduling::Normal)
    purpose.priority = std::max(purpose.priority, threads.settings.priority);
  purpose.locks_memory = purpose.locks_memory || threads.lock_memory;
}

void add_peer(Purpose& purpose, const profile::PeerProfile& peer) {
  add(purpose.interfaces, peer.interface);
  if (peer.vendor != dds::kLoopback) add(purpose.vendors, peer.vendor);
  purpose.multicast = purpose.multicast || peer.multicast;
  purpose.shared_memory = purpose.shared_memory || peer.shared_memory;
  add_threads(purpose, peer.threads);
  for (const profile::CspProfile& csp : peer.csps) {
    add(purpose.vendors, csp.vendor == dds::kLoopback ? "" : csp.vendor);
    add_threads(purpose, csp.threads);
  }
}

}  // namespace

Purpose purpose_of(const profile::MissionProfile& mission, const std::string& host) {
  Purpose purpose;
  purpose.domain = static_cast<std::uint32_t>(mission.domain);
  purpose.mission = mission.name;
  for (const profile::PeerProfile& peer : mission.peers) {
    if (launch::is_here(peer.host, host)) {
      add_peer(purpose, peer);
    } else {
      purpose.several_hosts = true;
    }
  }
  return purpose;
}

}  // namespace skein::command::doctor
