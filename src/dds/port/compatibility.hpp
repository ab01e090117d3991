#pragma once

#include <optional>

#include "dds/port/port.hpp"

namespace skein::dds {

/// Whether a writer and a reader share a partition; no partition is the one called "".
bool share_partition(const Qos& writer, const Qos& reader);

/// Compares the offered QoS of a writer with a reader's requested QoS (DDS 1.4, 2.2.3). They share
/// topic, type and partition: the first policy of which the writer offers less than the reader
/// wants, or nothing.
std::optional<Incompatibility> find_incompatibility(const std::string& topic, const Guid& peer,
                                                    const Qos& offered, const Qos& requested);

/// The same, where topic and partition are shared, and the types have different names.
std::optional<Incompatibility> find_other_type(const std::string& topic, const Guid& peer,
                                               const std::string& offered,
                                               const std::string& requested);

/// With who it is in its explanation: the name of the peer's participant, or its GUID where that is
/// not told.
Incompatibility with_other_side(Incompatibility why, const std::string& name);

}  // namespace skein::dds
