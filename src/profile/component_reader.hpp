#pragma once

#include "profile/component_description.hpp"
#include "profile/dictionary.hpp"
#include "xml_node.hpp"

namespace skein::profile {

/// What of the element can be read as a component description; the rest becomes findings.
ComponentDescription read_component(const XmlNode& node, FindingList& findings);

}  // namespace skein::profile
