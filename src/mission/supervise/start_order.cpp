#include "mission/supervise/start_order.hpp"

#include <algorithm>
#include <limits>

namespace skein::launch {
namespace {

constexpr std::size_t kOpen = std::numeric_limits<std::size_t>::max();

bool has_own_process(const profile::PeerProfile& peer, const std::string& csp) {
  const profile::CspProfile* found = csp.empty() ? nullptr : peer.find_csp(csp);
  return found != nullptr && found->process == profile::CspProcess::Own;
}

}  // namespace

StartOrder::StartOrder(const profile::MissionProfile& mission, const std::vector<bool>& is_here)
    : mission_(mission),
      composition_(mission),
      is_here_(is_here),
      layers_(mission.peers.size(), kOpen) {
  for (std::size_t layer = 0;; ++layer) {
    std::vector<std::size_t> next;
    std::vector<std::size_t> open;
    for (std::size_t peer = 0; peer < layers_.size(); ++peer) {
      if (layers_[peer] != kOpen) continue;
      const auto& needs = composition_.needs(peer);
      const bool waits = std::any_of(needs.begin(), needs.end(), [&](const profile::Need& need) {
        return waits_for(peer, need);
      });
      (waits ? open : next).push_back(peer);
    }
    for (const std::size_t peer : next.empty() ? open : next) layers_[peer] = layer;
    if (open.empty() || next.empty()) break;
  }
}

/// While the layers are made: whether nobody who provides it has one yet.
bool StartOrder::waits_for(std::size_t peer, const profile::Need& need) const {
  const auto& providers = composition_.providers(need.interface);
  return is_here_[peer] && !providers.empty() &&
         std::all_of(providers.begin(), providers.end(), [&](std::size_t provider) {
           return is_here_[provider] && layers_[provider] == kOpen;
         });
}

std::vector<Prerequisite> StartOrder::prerequisites(std::size_t peer,
                                                    const profile::CspProfile* csp) const {
  std::vector<Prerequisite> all;
  for (const profile::Need& need : composition_.needs(peer)) {
    const bool of_own_process = has_own_process(mission_.peers[peer], need.csp);
    if (csp != nullptr ? need.csp != csp->name : of_own_process) continue;
    Prerequisite prerequisite{need.interface, {}};
    bool elsewhere = false;
    for (const std::size_t provider : composition_.providers(need.interface)) {
      elsewhere = elsewhere || !is_here_[provider];
      if (layers_[provider] < layers_[peer])
        prerequisite.providers.push_back(mission_.peers[provider].name);
    }
    const bool known = std::any_of(all.begin(), all.end(), [&](const Prerequisite& other) {
      return other.interface == need.interface;
    });
    if (!known && !elsewhere && !prerequisite.providers.empty())
      all.push_back(std::move(prerequisite));
  }
  return all;
}

}  // namespace skein::launch
