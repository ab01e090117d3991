#pragma once

#include "skein/profile/thread_rules.hpp"
#include "xml_document.hpp"

namespace skein::profile {

/// The XML attributes `threads`, `scheduling`, `priority`, `nice`, `cpus`, `spin` and `lock_memory`
/// of a peer or CSP. Whether a CPU exists is the business of the host that runs it.
ThreadRules read_thread_rules(const XmlElement& element);

}  // namespace skein::profile
