#pragma once

#include <optional>
#include <string>
#include <vector>

#include "loaded_plugins.hpp"
#include "mission/profile/mission_profile.hpp"

namespace skein::launch {

/// Why a process would not run any code of its component, or not the code that its profile asks
/// for; and what to write instead.
struct CodeLack {
  std::string problem;
  std::string remedy;
};

/// What is missing in `plugins`, which are those of the peer and of the CSPs in its process: a
/// Body, if the component implements an interface; an activity, if it implements none; with
/// role="mission" a mission will do, too. Nothing if they have it. The component has been read.
std::optional<CodeLack> find_lack(const profile::PeerProfile& peer, const LoadedPlugins& plugins);

/// The same of a CSP, which is to be registered as one.
std::optional<CodeLack> find_lack(const profile::CspProfile& csp, const LoadedPlugins& plugins);

/// What the description declares against what its code implements: an error for each interface that
/// one of the two lacks.
std::vector<profile::Finding> compare(const profile::ComponentDescription& component,
                                      const InterfaceInfo& code);

/// An error for each value of a component's parameters that a check of its process's plugins
/// refuses, at the value's place. A value that the dictionary refuses is passed over.
std::vector<profile::Finding> find_wrong_values(const std::vector<profile::Setting>& settings,
                                                const profile::Dictionary& dictionary,
                                                const ComponentRegistry& registry);

}  // namespace skein::launch
