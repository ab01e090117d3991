#pragma once

#include "mission/profile/process_start.hpp"
#include "mission/xml/xml_element.hpp"

namespace skein::profile {

ProcessStart read_process_start(const XmlElement& element);

/// Findings for what read_process_start() reads, where there is no process that it could start.
void refuse_process_start(const XmlElement& element);

/// Findings for what a peer with a `program` of its own says to `skein peer` alone: nobody would
/// obey it. What it inherits is passed over.
void refuse_peer_options(const XmlElement& element);

}  // namespace skein::profile
