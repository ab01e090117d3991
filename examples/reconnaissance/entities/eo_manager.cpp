#include "eo_manager.hpp"

#include "topics.hpp"

namespace reconnaissance {

EoManager::EoManager(skein::Entity& entity, const skein::ParameterValues& values)
    : flight_(entity, topic::kFlightState),
      elements_(entity.subscription<recon::ElementOfInterest>(topic::kElements,
                                                              skein::TopicQos::state())),
      member_(entity, values) {}

}  // namespace reconnaissance
