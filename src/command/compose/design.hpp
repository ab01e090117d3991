#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "design_state.idl.hpp"
#include "mission/profile/mission_profile.hpp"
#include "repository.hpp"

namespace skein::command::compose {

/// All of a DesignState that follows from the text of a mission: elements, findings, entities
/// without their places. Of text that is no well-formed XML, only the findings. `checked`, unless
/// null: those of `skein check`; without them, what it finds without looking at this machine. Reads
/// the files that the mission names.
DesignState design_of(const std::string& text, const std::filesystem::path& file,
                      const profile::VariableValues& values, const Repository& repository,
                      const std::vector<profile::Finding>* checked = nullptr);

/// The findings in the output of `skein check --json`. Throws Unavailable for other text.
std::vector<profile::Finding> findings_in(const std::string& json);

/// How a mission in that folder names a file: relatively, unless they have nothing in common.
std::string reference_to(const std::filesystem::path& file, const std::filesystem::path& folder);

/// As XmlSource has it: no element.
inline constexpr int kNoElement = -1;

}  // namespace skein::command::compose
