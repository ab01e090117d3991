#pragma once

#include "finding_list.hpp"
#include "profile/dictionary.hpp"
#include "xml_document.hpp"

namespace skein::profile {

/// What of the document can be read as a dictionary; the rest becomes findings.
Dictionary read_dictionary(const XmlDocument& document, FindingList& findings);

}  // namespace skein::profile
