#pragma once

#include <string>

#include "skein/dds/port.hpp"

namespace skein::dds::cyclonedds {

/// Cyclone's configuration of one participant's domain, as XML. Everything that must not come from
/// the environment is in it: a domain that is made with a configuration of its own reads no
/// CYCLONEDDS_URI.
std::string configuration(const ParticipantOptions& options);

}  // namespace skein::dds::cyclonedds
