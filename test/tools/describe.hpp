#pragma once

#include <string>

#include "skein/detail/operation.hpp"
#include "skein/discovery.idl.hpp"
#include "skein/guid.hpp"

namespace skein::test {

/// The description of a service, as an entity would register it.
inline discovery::ServiceDescription describe(const InterfaceInfo& interface, const Guid& provider,
                                              const std::string& entity) {
  discovery::ServiceDescription description;
  description.provider = provider.bytes;
  description.service = interface.name;
  description.entity = entity;
  for (const InterfaceInfo* base : interface.bases) description.bases.emplace_back(base->name);
  for (const OperationInfo& operation : interface.operations) {
    description.operations.push_back(
        {std::string(operation.name), operation.hash, operation.signature});
  }
  return description;
}

}  // namespace skein::test
