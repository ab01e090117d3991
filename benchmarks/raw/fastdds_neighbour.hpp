#pragma once

#include "raw/main.hpp"

namespace skein::benchmarks::raw {

/// raw/neighbour.hpp's peer on Fast DDS: one of `options.peers`.
void fastdds_neighbour(const RawOptions& options);

}  // namespace skein::benchmarks::raw
