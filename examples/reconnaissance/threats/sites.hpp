#pragma once

#include <cstdint>
#include <string>

#include "threats/radar.hpp"

namespace reconnaissance {

/// A site of one of emitter_types(), with its antenna on a mast above the ground where it stands.
/// It sees a square metre with a probability of 0.9 from the type's distance on, transmits what is
/// in the middle of the library's intervals, and its weapon reaches as far as the type's, up to
/// 5 km high. Throws skein::InvalidArgument for a type that is unknown; the text lists the known
/// ones.
RadarSite site_of_type(const std::string& type, std::uint32_t emitter, const Local& ground,
                       double active_from_s);

}  // namespace reconnaissance
