#pragma once

#include <filesystem>

namespace skein {

/// Where a user's programs keep what they remember: `$XDG_STATE_HOME/skein`, by default
/// `~/.local/state/skein`; empty if the environment names neither.
std::filesystem::path state_folder();

}  // namespace skein
