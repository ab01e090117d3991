#include "object_tracker.hpp"

#include "topics.hpp"

namespace reconnaissance {

ObjectTracker::ObjectTracker(skein::Entity& entity, const skein::ParameterValues& values)
    : flight_(entity, topic::kFlightState),
      images_(entity.subscription<recon::ImageReport>(topic::kImage, skein::TopicQos{})),
      member_(entity, values) {}

}  // namespace reconnaissance
