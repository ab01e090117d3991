#pragma once

#include "mission/profile/restart_rules.hpp"
#include "mission/xml/xml_element.hpp"

namespace skein::profile {

/// What kProcessAttributes of a peer or CSP say. `on_loss`: the policy where the element names
/// none.
ProcessRules read_process_rules(const XmlElement& element, LossPolicy on_loss);

/// Findings for these attributes, and for `lock_memory`, where there is no process that they could
/// rule.
void refuse_process_rules(const XmlElement& element);

}  // namespace skein::profile
