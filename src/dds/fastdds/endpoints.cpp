#include "endpoints.hpp"

#include "../compatibility.hpp"

namespace skein::dds::fastdds {

void Endpoints::found(const Guid& guid, Endpoint endpoint) {
  std::lock_guard lock(mutex_);
  std::erase_if(watchers_, [](const Watcher& watcher) { return watcher.events.expired(); });
  for (Watcher& watcher : watchers_) compare(watcher, guid, endpoint);
  known_.insert_or_assign(guid, std::move(endpoint));
}

void Endpoints::lost(const Guid& guid) {
  std::lock_guard lock(mutex_);
  known_.erase(guid);
}

void Endpoints::watch(const Endpoint& endpoint, const std::shared_ptr<EndpointEvents>& events) {
  std::lock_guard lock(mutex_);
  watchers_.push_back({endpoint, events});
  for (const auto& [guid, other] : known_) compare(watchers_.back(), guid, other);
}

void Endpoints::compare(Watcher& watcher, const Guid& guid, const Endpoint& endpoint) {
  const Endpoint& own = watcher.endpoint;
  if (own.side == endpoint.side || own.topic != endpoint.topic || own.type != endpoint.type) return;
  const Qos& offered = own.side == Side::Writer ? own.qos : endpoint.qos;
  const Qos& requested = own.side == Side::Writer ? endpoint.qos : own.qos;
  if (!share_partition(offered, requested)) return;
  const auto why = find_incompatibility(own.topic, guid, offered, requested);
  if (!why || !watcher.told.insert(guid).second) return;
  if (const auto events = watcher.events.lock()) events->incompatible(*why);
}

}  // namespace skein::dds::fastdds
