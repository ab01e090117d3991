#include "skein/topic_qos.hpp"

namespace skein {

TopicQos TopicQos::sensor(std::chrono::milliseconds lifespan) {
  constexpr std::uint32_t kNewest = 4;
  TopicQos qos;
  qos.reliable = false;
  qos.history_depth = kNewest;
  qos.lifespan = lifespan;
  return qos;
}

TopicQos TopicQos::command(std::int32_t strength, std::chrono::milliseconds period) {
  TopicQos qos;
  qos.history_depth = 1;
  qos.deadline = 2 * period;
  qos.liveliness_lease = std::chrono::seconds(1);
  qos.exclusive = true;
  qos.strength = strength;
  return qos;
}

TopicQos TopicQos::state() {
  TopicQos qos;
  qos.transient_local = true;
  qos.history_depth = 1;
  qos.max_waiting = 0;  // a late joiner is sent all keys at once, and is to miss none
  return qos;
}

}  // namespace skein
