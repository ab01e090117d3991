#pragma once

#include "mission/profile/mission_profile.hpp"
#include "mission/xml/finding_list.hpp"

namespace skein::profile {

/// What can be told of one component by itself: attributes and parameters against the dictionary,
/// and what it says twice.
void check_component(const ComponentDescription& component, const Dictionary& dictionary,
                     FindingList& findings);

/// The parameters that a profile sets for `owner`, a peer or `peer/csp` that stands at `where`,
/// against the component and the dictionary; and those that the component requires. A component
/// that implements no interface and declares no parameters may be given any of the dictionary.
void check_settings(const std::string& owner, const std::vector<Setting>& settings,
                    const SourcePosition& where, const ComponentDescription& component,
                    const Dictionary& dictionary, FindingList& findings);

}  // namespace skein::profile
