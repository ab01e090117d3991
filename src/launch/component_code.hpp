#pragma once

#include <optional>
#include <string>

#include "profile/mission_profile.hpp"
#include "skein/component_registry.hpp"

namespace skein::launch {

/// Why a process would not run any code of its component, or not the code that its profile asks
/// for; and what to write instead.
struct CodeLack {
  std::string problem;
  std::string remedy;
};

/// What is missing in `registry`, which holds the plugins of the peer and of the CSPs in its
/// process: a Body, if the component implements an interface; an activity, if it implements none;
/// with role="mission" a mission will do, too. Nothing if the registry has it. The component has
/// been read.
std::optional<CodeLack> find_lack(const profile::PeerProfile& peer,
                                  const ComponentRegistry& registry);

/// The same of a CSP, which is to be registered as one.
std::optional<CodeLack> find_lack(const profile::CspProfile& csp,
                                  const ComponentRegistry& registry);

}  // namespace skein::launch
