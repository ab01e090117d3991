#pragma once

#include <cstring>

#include "skein/guid.hpp"

namespace skein::dds::fastdds {

/// Fast DDS's GUID_t; the other identity is its InstanceHandle_t.
template <class Identity>
concept HasPrefix = requires(Identity identity) {
  identity.guidPrefix;
};

template <HasPrefix Identity>
Guid to_guid(const Identity& identity) {
  Guid result;
  std::memcpy(result.bytes.data(), identity.guidPrefix.value, 12);
  std::memcpy(result.bytes.data() + 12, identity.entityId.value, 4);
  return result;
}
template <class Handle>
Guid to_guid(const Handle& handle) {
  Guid result;
  for (std::size_t i = 0; i < result.bytes.size(); ++i) result.bytes[i] = handle.value[i];
  return result;
}

template <HasPrefix Identity>
Identity from_guid(const Guid& guid) {
  Identity result;
  std::memcpy(result.guidPrefix.value, guid.bytes.data(), 12);
  std::memcpy(result.entityId.value, guid.bytes.data() + 12, 4);
  return result;
}
template <class Handle>
Handle from_guid(const Guid& guid) {
  Handle result;
  for (std::size_t i = 0; i < guid.bytes.size(); ++i) result.value[i] = guid.bytes[i];
  return result;
}

}  // namespace skein::dds::fastdds
