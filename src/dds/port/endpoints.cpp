#include "endpoints.hpp"

#include <utility>

#include "compatibility.hpp"

namespace skein::dds {

void Endpoints::found(const Guid& guid, Endpoint endpoint) {
  std::lock_guard lock(mutex_);
  for (EndpointWatch* watch : watches_) watch->consider(guid, endpoint);
  known_.insert_or_assign(guid, std::move(endpoint));
}

void Endpoints::lost(const Guid& guid) {
  std::lock_guard lock(mutex_);
  known_.erase(guid);
}

EndpointWatch::EndpointWatch(Endpoints& all, Endpoint own, Told told)
    : all_(all), own_(std::move(own)), told_(std::move(told)) {
  std::lock_guard lock(all_.mutex_);
  all_.watches_.insert(this);
  for (const auto& [guid, endpoint] : all_.known_) consider(guid, endpoint);
}

EndpointWatch::~EndpointWatch() {
  std::lock_guard lock(all_.mutex_);
  all_.watches_.erase(this);
}

void EndpointWatch::consider(const Guid& peer, const Endpoint& endpoint) {
  if (own_.side == endpoint.side || own_.topic != endpoint.topic) return;
  const Endpoint& writer = own_.side == Side::Writer ? own_ : endpoint;
  const Endpoint& reader = own_.side == Side::Writer ? endpoint : own_;
  if (!share_partition(writer.qos, reader.qos)) return;
  auto why = find_other_type(own_.topic, peer, writer.type, reader.type);
  if (!why) why = find_incompatibility(own_.topic, peer, writer.qos, reader.qos);
  if (!why) return;
  {
    std::lock_guard lock(mutex_);
    if (!refused_.insert(peer).second) return;
    any_ = true;
  }
  if (told_) told_(with_other_side(*why, endpoint.participant));
}

bool EndpointWatch::refuses(const Guid& peer) const {
  if (!any_) return false;
  std::lock_guard lock(mutex_);
  return refused_.contains(peer);
}

}  // namespace skein::dds
