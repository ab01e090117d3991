#pragma once

#include "mission/profile/thread_rules.hpp"
#include "mission/xml/xml_element.hpp"

namespace skein::profile {

/// Of the whole process.
inline constexpr const char* kLockMemoryAttribute = "lock_memory";

/// What kThreadAttributes, and of a peer `threads`, say. Whether a CPU exists is the business of
/// the host that runs it.
ThreadRules read_thread_rules(const XmlElement& element);

}  // namespace skein::profile
