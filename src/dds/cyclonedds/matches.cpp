#include "matches.hpp"

#include <algorithm>

namespace skein::dds::cyclonedds {

Matches::Matches(List list, Identify identify, Told on_matched, Told on_liveliness)
    : list_(std::move(list)),
      identify_(std::move(identify)),
      on_matched_(std::move(on_matched)),
      on_liveliness_(std::move(on_liveliness)) {}

/// Nothing where the endpoint is being deleted.
std::optional<std::vector<dds_instance_handle_t>> Matches::handles() const {
  std::vector<dds_instance_handle_t> handles(16);
  for (;;) {
    const dds_return_t count = list_(handles.data(), handles.size());
    if (count < 0) return std::nullopt;
    const auto needed = static_cast<std::size_t>(count);
    const bool complete = needed <= handles.size();
    handles.resize(complete ? needed : needed * 2);
    if (complete) return handles;
  }
}

std::vector<std::pair<Guid, bool>> Matches::compare() {
  const auto listed = handles();
  if (!listed) return {};
  std::vector<std::pair<Guid, bool>> changes;
  std::lock_guard lock(mutex_);
  std::erase_if(peers_, [&](const auto& peer) {
    const bool gone = std::ranges::find(*listed, peer.first) == listed->end();
    if (gone) {
      changes.emplace_back(peer.second, false);
      silent_.erase(peer.first);
    }
    return gone;
  });
  for (const dds_instance_handle_t handle : *listed) {
    if (peers_.contains(handle)) continue;
    const Guid guid = identify_(handle);
    if (guid.is_nil()) continue;
    peers_.emplace(handle, guid);
    changes.emplace_back(guid, true);
  }
  return changes;
}

void Matches::update() {
  std::lock_guard telling(telling_);
  for (const auto& [peer, matched] : compare()) {
    if (on_matched_) on_matched_(peer, matched);
  }
}

void Matches::liveliness_changed(dds_instance_handle_t peer, bool alive) {
  std::lock_guard telling(telling_);
  Guid guid;
  {
    std::lock_guard lock(mutex_);
    const auto found = peers_.find(peer);
    if (found == peers_.end()) return;
    // A newly matched writer is reported as alive too; only a return is news.
    if (alive ? silent_.erase(peer) == 0 : !silent_.insert(peer).second) return;
    guid = found->second;
  }
  if (on_liveliness_) on_liveliness_(guid, alive);
}

std::vector<Guid> Matches::current() const {
  std::lock_guard lock(mutex_);
  std::vector<Guid> guids;
  for (const auto& [handle, guid] : peers_) guids.push_back(guid);
  return guids;
}

}  // namespace skein::dds::cyclonedds
