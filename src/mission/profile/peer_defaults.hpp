#pragma once

#include "mission/xml/xml_node.hpp"
#include "variables.hpp"

namespace skein::profile {

/// The name of the group that a peer came from, as an attribute that the notation does not have.
inline constexpr const char* kGroupAttribute = "<group>";

/// Makes a list of complete peers of a mission whose parts are in place:
/// - variables get their values
/// - a peer with a `count` becomes so many, with `-1`, `-2`, ... behind its name, or with
///   `${instance}` wherever it stands in its attributes and what it holds
/// - groups are gone: each peer has what it does not say itself from its group, then from the
///   mission (`inherited`), and so has its environment
///
/// Where that makes too much, it is a finding, and peers are left out.
void complete_peers(XmlNode& mission, const Variables& variables, FindingList& findings);

}  // namespace skein::profile
