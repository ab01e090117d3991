#pragma once

#include "skein/entity/head_options.hpp"
#include "xml_document.hpp"

namespace skein::profile {

/// The XML attributes `strategy`, `history`, `decision_log`, `exploration`, `most_stuck`,
/// `quarantine_after`, `first_quarantine` and `longest_quarantine` of a peer.
HeadOptions read_head_options(const XmlElement& element);

}  // namespace skein::profile
