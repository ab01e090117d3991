#pragma once

#include "finding_list.hpp"
#include "profile/component_description.hpp"
#include "profile/dictionary.hpp"
#include "xml_document.hpp"

namespace skein::profile {

/// What of the document can be read as a component description; the rest becomes findings.
ComponentDescription read_component(const XmlDocument& document, FindingList& findings);

}  // namespace skein::profile
