#include "radar_warner.hpp"

#include "topics.hpp"

namespace reconnaissance {

RadarWarner::RadarWarner(skein::Entity& entity, const skein::ParameterValues& values)
    : flight_(entity, topic::kFlightState),
      emissions_(entity.subscription<recon::Emission>(topic::kEmission, stream_qos())),
      member_(entity, values) {}

}  // namespace reconnaissance
