#pragma once

#include <span>

#include "skein/guid.hpp"

namespace skein {

class CallContext;

/// The services that wait for a call's answer: first the chain of `outer`, if this call runs on the
/// thread of another one, or else those that the request names; last this service, whose identity
/// is `strand`, unless it is nil: a call that is answered later blocks no thread.
struct WaitingServices {
  const CallContext* outer = nullptr;
  std::span<const Guid> named{};
  Guid strand{};
};

}  // namespace skein
