#pragma once

#include "raw/main.hpp"

namespace skein::benchmarks::raw {

/// raw/neighbour.hpp's peer on Cyclone DDS: one of `options.peers`.
void cyclonedds_neighbour(const RawOptions& options);

}  // namespace skein::benchmarks::raw
