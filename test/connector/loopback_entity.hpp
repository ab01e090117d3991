#pragma once

#include <memory>
#include <string>
#include <utility>

#include "skein/entity.hpp"

namespace skein::test {

/// An entity on the loopback network, so that all but its calls through shared memory stays within
/// the process.
inline std::unique_ptr<Entity> make_entity(const std::string& name,
                                           bool shared_memory_calls = true) {
  EntityOptions options;
  options.name = name;
  options.vendor = dds::load_vendor("loopback");
  options.domain = 18;
  options.shared_memory_calls = shared_memory_calls;
  return std::make_unique<Entity>(std::move(options));
}

}  // namespace skein::test
