#pragma once

#include <span>
#include <string>
#include <vector>

namespace skein::command {

/// The long option for a short one that users of other software type: `--output` for `-o`. Empty:
/// none is known.
std::string familiar_option(const std::string& theirs);

/// What users of other robotics software type, and what does that in Skein.
struct FamiliarName {
  std::string theirs;  ///< One word, or two: `topic list`.
  std::string ours;    ///< A command of Skein's.
};

std::span<const FamiliarName> familiar_names();

/// Skein's command for what the words begin with; empty where nothing is known of them.
std::string familiar_name(const std::vector<std::string>& words);

}  // namespace skein::command
