#pragma once

#include "mission/component/dictionary.hpp"
#include "mission/xml/finding_list.hpp"
#include "mission/xml/xml_node.hpp"

namespace skein::profile {

/// What of the document can be read as a dictionary; the rest becomes findings.
Dictionary read_dictionary(const XmlNode& node, FindingList& findings);

}  // namespace skein::profile
