#pragma once

#include <cstring>

#include "skein/guid.hpp"

namespace skein::dds::fastdds {

/// Of a GUID_t or an InstanceHandle_t of Fast DDS's.
template <class Identity>
Guid to_guid(const Identity& identity) {
  Guid result;
  if constexpr (requires { identity.guidPrefix; }) {
    std::memcpy(result.bytes.data(), identity.guidPrefix.value, 12);
    std::memcpy(result.bytes.data() + 12, identity.entityId.value, 4);
  } else {
    for (std::size_t i = 0; i < result.bytes.size(); ++i) result.bytes[i] = identity.value[i];
  }
  return result;
}

template <class Identity>
Identity from_guid(const Guid& guid) {
  Identity result;
  if constexpr (requires { result.guidPrefix; }) {
    std::memcpy(result.guidPrefix.value, guid.bytes.data(), 12);
    std::memcpy(result.entityId.value, guid.bytes.data() + 12, 4);
  } else {
    for (std::size_t i = 0; i < guid.bytes.size(); ++i) result.value[i] = guid.bytes[i];
  }
  return result;
}

}  // namespace skein::dds::fastdds
