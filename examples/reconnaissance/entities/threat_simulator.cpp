#include "threat_simulator.hpp"

#include "topics.hpp"

namespace reconnaissance {

ThreatSimulator::ThreatSimulator(skein::Entity& entity, const skein::ParameterValues& values)
    : truth_(entity, topic::kTruth), member_(entity, values) {}

}  // namespace reconnaissance
