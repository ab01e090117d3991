#include "composition.hpp"

#include <algorithm>
#include <set>

namespace skein::profile {

Composition::Composition(const MissionProfile& mission) : mission_(mission) {
  for (std::size_t i = 0; i < mission.peers.size(); ++i) {
    const auto& peer = mission.peers[i];
    if (peer.component) {
      for (const auto& item : peer.component->interfaces) providers_[item.type].push_back(i);
    }
    for (const auto& csp : peer.csps) {
      if (!csp.component) continue;
      for (const auto& item : csp.component->interfaces) {
        managed_.emplace(item.type, peer.name + "/" + csp.name);
      }
    }
    add_needs(peer);
  }
}

void Composition::add_needs(const PeerProfile& peer) {
  std::set<std::string> own;
  std::vector<Need> needs;
  if (peer.component) {
    for (const auto& item : peer.component->dependencies)
      needs.push_back({item.type, item.where, ""});
  }
  for (const auto& csp : peer.csps) {
    if (!csp.component) continue;
    for (const auto& item : csp.component->interfaces) own.insert(item.type);
    for (const auto& item : csp.component->dependencies) {
      needs.push_back({item.type, item.where, csp.name});
    }
  }
  std::erase_if(needs, [&](const Need& need) { return own.count(need.interface) > 0; });
  needs_.push_back(std::move(needs));
}

const std::vector<std::size_t>& Composition::providers(const std::string& interface) const {
  static const std::vector<std::size_t> kNone;
  const auto found = providers_.find(interface);
  return found == providers_.end() ? kNone : found->second;
}

std::string Composition::csp_with(const std::string& interface) const {
  const auto found = managed_.find(interface);
  return found == managed_.end() ? "" : found->second;
}

std::vector<std::string_view> Composition::public_interfaces() const {
  std::vector<std::string_view> names;
  for (const auto& [interface, peers] : providers_) names.push_back(interface);
  return names;
}

namespace {

class CycleSearch {
 public:
  explicit CycleSearch(const Composition& composition)
      : composition_(composition), settled_(composition.mission().peers.size(), false) {}

  std::vector<std::vector<std::size_t>> run() {
    std::vector<std::vector<std::size_t>> cycles;
    for (std::size_t peer = 0; peer < settled_.size(); ++peer) {
      settle_all();
      while (!settled_[peer]) {
        cycles.push_back(cycle_from(peer));
        for (const std::size_t member : cycles.back()) settled_[member] = true;
        settle_all();
      }
    }
    return cycles;
  }

 private:
  /// Settles every peer whose needs are all provided by settled ones, until none is left.
  void settle_all() {
    for (bool again = true; again;) {
      again = false;
      for (std::size_t peer = 0; peer < settled_.size(); ++peer) {
        if (settled_[peer] || open_need(peer) != nullptr) continue;
        settled_[peer] = again = true;
      }
    }
  }

  /// A need that has providers, none of them settled; null if there is none.
  const Need* open_need(std::size_t peer) const {
    for (const auto& need : composition_.needs(peer)) {
      const auto& providers = composition_.providers(need.interface);
      const bool open = std::none_of(providers.begin(), providers.end(),
                                     [&](std::size_t provider) { return settled_[provider]; });
      if (open && !providers.empty()) return &need;
    }
    return nullptr;
  }

  /// Every unsettled peer has an open need, so that walking along them must come round.
  std::vector<std::size_t> cycle_from(std::size_t peer) const {
    std::vector<std::size_t> way;
    while (std::find(way.begin(), way.end(), peer) == way.end()) {
      way.push_back(peer);
      peer = composition_.providers(open_need(peer)->interface).front();
    }
    way.erase(way.begin(), std::find(way.begin(), way.end(), peer));
    return way;
  }

  const Composition& composition_;
  std::vector<bool> settled_;
};

}  // namespace

std::vector<std::vector<std::size_t>> dependency_cycles(const Composition& composition) {
  return CycleSearch(composition).run();
}

}  // namespace skein::profile
