#pragma once

#include "skein/profile/restart_rules.hpp"
#include "xml_document.hpp"

namespace skein::profile {

/// The XML attributes `restart`, `restart_delay`, `max_restart_delay`, `max_restarts`,
/// `restart_window`, `ready_timeout` and `stop_timeout` of a peer or CSP.
ProcessRules read_process_rules(const XmlElement& element);

/// Findings for these attributes where there is no process that they could rule.
void refuse_process_rules(const XmlElement& element);

}  // namespace skein::profile
