#pragma once

#include <optional>

#include "skein/clock.hpp"
#include "skein/entity.hpp"
#include "skein/loopback.hpp"

namespace skein::benchmarks {

/// An entity that needs no vendor, because it speaks to nobody outside its process.
struct Alone {
  SystemClock clock{};
  dds::LoopbackNetwork network{clock};
  std::optional<Entity> entity{};

  Alone() {
    EntityOptions options;
    options.name = "alone";
    options.vendor = network.vendor();
    entity.emplace(options);
  }
};

}  // namespace skein::benchmarks
