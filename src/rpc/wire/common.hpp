#pragma once

#include <string>
#include <vector>

#include "skein/call_context.hpp"
#include "skein/detail/operation.hpp"

/// What both ends of a transport share.
namespace skein::rpc {

/// A message that needed more is not kept for the next one.
inline constexpr std::size_t kKeptCapacity = 4 << 20;

/// What a TimedOut ends with, for the caller.
inline constexpr const char* kMoreTime = "; within() on the proxy sets a longer limit";

/// An operation's name as it stands in a text.
inline std::string quoted(const OperationInfo& operation) {
  return "'" + std::string(operation.name) + "'";
}

/// The services that wait for a call which this thread is about to make, and to wait for.
inline std::vector<Guid> inherited_chain() {
  const CallContext* context = CallContext::current();
  return context ? context->chain() : std::vector<Guid>();
}

}  // namespace skein::rpc
