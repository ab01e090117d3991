#pragma once

#include <fastdds/rtps/common/Guid.h>
#include <fastdds/rtps/common/InstanceHandle.h>

#include <cstring>

#include "skein/guid.hpp"

namespace skein::dds::fastdds {

namespace rtps = eprosima::fastrtps::rtps;

inline Guid to_guid(const rtps::GUID_t& guid) {
  Guid result;
  std::memcpy(result.bytes.data(), guid.guidPrefix.value, 12);
  std::memcpy(result.bytes.data() + 12, guid.entityId.value, 4);
  return result;
}

inline Guid to_guid(const rtps::InstanceHandle_t& handle) {
  Guid result;
  for (std::size_t i = 0; i < result.bytes.size(); ++i) result.bytes[i] = handle.value[i];
  return result;
}

inline rtps::GUID_t to_rtps(const Guid& guid) {
  rtps::GUID_t result;
  std::memcpy(result.guidPrefix.value, guid.bytes.data(), 12);
  std::memcpy(result.entityId.value, guid.bytes.data() + 12, 4);
  return result;
}

inline rtps::InstanceHandle_t to_handle(const Guid& key) {
  rtps::InstanceHandle_t handle;
  for (std::size_t i = 0; i < key.bytes.size(); ++i) handle.value[i] = key.bytes[i];
  return handle;
}

}  // namespace skein::dds::fastdds
