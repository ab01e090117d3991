#pragma once

#include <string>
#include <utility>
#include <vector>

#include "dds/port/port.hpp"
#include "skein/call_context.hpp"
#include "skein/detail/operation.hpp"
#include "skein/detail/representation.hpp"

/// What both ends of a transport share.
namespace skein::rpc {

/// A message that needed more is not kept for the next one.
inline constexpr std::size_t kKeptCapacity = 4 << 20;

/// What a TimedOut ends with, for the caller.
inline constexpr const char* kMoreTime = "; within() on the proxy sets a longer limit";

inline dds::Qos call_qos(Representation representation, std::vector<std::string> partitions) {
  dds::Qos qos;
  if (is_xcdr2(representation)) qos.representation = dds::DataRepresentation::Xcdr2;
  qos.partitions = std::move(partitions);
  return qos;
}

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
