#pragma once

#include "mission/xml/xml_node.hpp"

namespace skein::profile {

/// Names become parts of topics, partitions, log lines and command lines. A finding, and false,
/// where one has more than letters, digits, _ and -, or is too long.
bool demand_plain_name(const XmlAttribute& name, FindingList& findings);

}  // namespace skein::profile
