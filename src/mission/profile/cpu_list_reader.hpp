#pragma once

#include <vector>

#include "mission/xml/xml_element.hpp"

namespace skein::profile {

/// The numbers in a list such as `0,2-3`, sorted, each once; none where the attribute is missing.
std::vector<unsigned> read_cpus(const XmlElement& element, const char* name);

}  // namespace skein::profile
