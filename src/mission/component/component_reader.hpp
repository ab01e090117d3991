#pragma once

#include "mission/component/component_description.hpp"
#include "mission/component/dictionary.hpp"
#include "mission/xml/xml_node.hpp"

namespace skein::profile {

/// What of the element can be read as a component description; the rest becomes findings.
ComponentDescription read_component(const XmlNode& node, FindingList& findings);

}  // namespace skein::profile
