#pragma once

#include "finding_list.hpp"
#include "profile/mission_profile.hpp"

namespace skein::profile {

/// What can be told of one component by itself: attributes and parameters against the dictionary,
/// and what it says twice.
void check_component(const ComponentDescription& component, const Dictionary& dictionary,
                     FindingList& findings);

/// The parameters that a profile sets, against the component and the dictionary. A component that
/// implements no interface is a client only, and may be given any parameter of the dictionary.
void check_settings(const std::vector<Setting>& settings, const ComponentDescription& component,
                    const Dictionary& dictionary, FindingList& findings);

}  // namespace skein::profile
