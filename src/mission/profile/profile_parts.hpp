#pragma once

#include <filesystem>
#include <set>

#include "mission/xml/xml_node.hpp"
#include "variables.hpp"

namespace skein::profile {

/// Puts what the parts hold in place of each `<include file=.../>` of a profile, and moves its
/// `<variable>` elements, and those of the parts, to `variables`, in the order in which they stand.
/// A part that cannot be read, is no part or includes itself is a finding. Returns the files of the
/// parts that were read.
std::set<std::filesystem::path> put_parts_in_place(XmlNode& mission, Variables& variables,
                                                   FindingList& findings);

}  // namespace skein::profile
