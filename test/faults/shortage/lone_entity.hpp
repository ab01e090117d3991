#pragma once

#include <memory>
#include <utility>

#include "skein/entity.hpp"

namespace skein::test {

/// An entity of programs that run alone in their network.
inline std::unique_ptr<Entity> make_lone_entity(const std::shared_ptr<dds::Vendor>& vendor,
                                                const char* name) {
  EntityOptions options;
  options.name = name;
  options.vendor = vendor;
  options.domain = 17;
  return std::make_unique<Entity>(std::move(options));
}

}  // namespace skein::test
