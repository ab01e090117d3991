#include "collision_manager.hpp"

#include "topics.hpp"

namespace reconnaissance {

CollisionManager::CollisionManager(skein::Entity& entity, const skein::ParameterValues& values)
    : flight_(entity, topic::kFlightState),
      intruders_(entity.subscription<recon::Intruder>(topic::kIntruder, stream_qos())),
      member_(entity, values) {}

}  // namespace reconnaissance
