#pragma once

#include <string>

#include "skein/discovery.idl.hpp"
#include "skein/guid.hpp"

namespace skein::test {

/// An identity within a participant; without one, within that of all descriptions made here.
inline Guid guid(std::uint8_t number, const Guid& participant = {}) {
  Guid guid = participant.participant();
  guid.bytes[12] = number;
  return guid;
}

/// A provider of `service` by `entity` in system `uav-1`; the number is its identity.
inline discovery::ServiceDescription description(std::uint8_t number, const std::string& service,
                                                 const std::string& entity) {
  discovery::ServiceDescription description;
  description.provider = guid(number).bytes;
  description.service = service;
  description.entity = entity;
  description.system = "uav-1";
  description.process = "skein/process-of-" + entity;
  return description;
}

}  // namespace skein::test
