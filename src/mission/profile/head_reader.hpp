#pragma once

#include "mission/xml/xml_element.hpp"
#include "skein/entity.hpp"

namespace skein::profile {

/// What kHeadAttributes say. Any word is taken for a strategy: a plugin may bring it.
HeadOptions read_head_options(const XmlElement& element);

/// Warnings of these attributes at a peer that has nothing to choose among.
void warn_of_head_without_csps(const XmlElement& element);

}  // namespace skein::profile
