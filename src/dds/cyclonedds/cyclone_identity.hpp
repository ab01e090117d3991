#pragma once

#include <arpa/inet.h>
#include <dds/dds.h>
#include <dds/ddsi/ddsi_guid.h>

#include <cstring>

#include "skein/guid.hpp"

namespace skein::dds::cyclonedds {

/// Cyclone's API gives GUIDs as they travel.
inline Guid to_guid(const dds_guid_t& guid) {
  Guid result;
  std::memcpy(result.bytes.data(), guid.v, result.bytes.size());
  return result;
}

/// Inside, Cyclone holds them in the host's byte order.
inline Guid to_guid(const ddsi_guid_t& guid) {
  const std::uint32_t words[4] = {htonl(guid.prefix.u[0]), htonl(guid.prefix.u[1]),
                                  htonl(guid.prefix.u[2]), htonl(guid.entityid.u)};
  Guid result;
  std::memcpy(result.bytes.data(), words, result.bytes.size());
  return result;
}

inline ddsi_guid_t to_internal(const Guid& guid) {
  std::uint32_t words[4];
  std::memcpy(words, guid.bytes.data(), sizeof words);
  ddsi_guid_t result;
  for (int i = 0; i < 3; ++i) result.prefix.u[i] = ntohl(words[i]);
  result.entityid.u = ntohl(words[3]);
  return result;
}

}  // namespace skein::dds::cyclonedds
