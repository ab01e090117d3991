#include "hub.hpp"

namespace skein::dds::loopback {

void Hub::watch_deadline(const std::shared_ptr<EndpointCore>& endpoint, const KeyHash& key,
                         InstanceState state) {
  if (!endpoint->deadline) return;
  if (state == InstanceState::Disposed) {
    endpoint->deadline->ended(key);
  } else {
    endpoint->deadline->heard(key, clock_.now());
  }
  schedule_deadline(endpoint);
}

void Hub::schedule_deadline(const std::shared_ptr<EndpointCore>& endpoint) {
  const auto next = endpoint->deadline->next();
  if (endpoint->deadline_set || endpoint->closed || !next) return;
  endpoint->deadline_set = true;
  after(*next - clock_.now(), [endpoint](Hub& hub) { hub.check_deadline(endpoint); });
}

void Hub::check_deadline(const std::shared_ptr<EndpointCore>& endpoint) {
  endpoint->deadline_set = false;
  if (endpoint->closed) return;
  for (const KeyHash& key : endpoint->deadline->take_overdue(clock_.now())) {
    if (const auto reader = readers_.find(endpoint->guid); reader != readers_.end()) {
      reader->second->gate.release(key);
    }
    post(endpoint.get(), [endpoint, key] { endpoint->deadline_missed(key); });
  }
  schedule_deadline(endpoint);
}

}  // namespace skein::dds::loopback
