#include "eoi_manager.hpp"

#include "topics.hpp"

namespace reconnaissance {

EoiManager::EoiManager(skein::Entity& entity, const skein::ParameterValues& values)
    : flight_(entity, topic::kFlightState),
      images_(entity.subscription<recon::ImageReport>(topic::kImage, skein::TopicQos{})),
      tracks_(entity.subscription<recon::ObjectTrack>(topic::kTrack, stream_qos())),
      member_(entity, values) {}

}  // namespace reconnaissance
