#pragma once

#include <array>

#include "profile/restart_rules.hpp"
#include "xml_element.hpp"

namespace skein::profile {

/// The XML attributes of a peer or CSP that read_process_rules() reads.
inline constexpr std::array kProcessAttributes{
    "restart",       "restart_delay",    "max_restart_delay", "max_restarts", "restart_window",
    "ready_timeout", "progress_timeout", "stop_timeout",      "on_loss"};

/// `on_loss`: the policy where the element names none.
ProcessRules read_process_rules(const XmlElement& element, LossPolicy on_loss);

/// Findings for these attributes, and for `lock_memory`, where there is no process that they could
/// rule.
void refuse_process_rules(const XmlElement& element);

}  // namespace skein::profile
