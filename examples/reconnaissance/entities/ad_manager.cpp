#include "ad_manager.hpp"

#include "topics.hpp"

namespace reconnaissance {

AdManager::AdManager(skein::Entity& entity, const skein::ParameterValues& values)
    : flight_(entity, topic::kFlightState),
      emitters_(entity.subscription<recon::EmitterReport>(topic::kEmitter, stream_qos())),
      member_(entity, values) {}

}  // namespace reconnaissance
