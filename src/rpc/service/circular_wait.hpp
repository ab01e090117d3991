#pragma once

#include <cstddef>
#include <string_view>

#include "skein/guid.hpp"

namespace skein::rpc {

class ServiceOwner;
struct Invocation;

/// Refuses the calls that would wait for themselves, because each thread that could answer them is
/// blocked in a call that led to them.
struct CircularWait {
  std::string_view service;
  Guid strand;              ///< Of the service's threads.
  std::size_t threads = 1;  ///< At least one.

  /// Throws Unavailable with the names of the services in the circle, as the owner knows them.
  void refuse(const Invocation& invocation, const ServiceOwner& owner) const;
};

}  // namespace skein::rpc
