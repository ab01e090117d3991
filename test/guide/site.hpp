#pragma once

#include "skein/entity.hpp"
#include "surveyor.hpp"

/// A drone that surveys and a station that asks it, each an entity of its own.
struct Site {
  std::shared_ptr<skein::dds::Vendor> vendor = skein::dds::load_vendor("loopback");
  skein::Entity drone{skein::EntityOptions{.name = "drone", .vendor = vendor}};
  skein::Entity station{skein::EntityOptions{.name = "station", .vendor = vendor}};
};

inline const survey::Area kField{400, 300};
