#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "mission/profile/mission_profile.hpp"
#include "mission/xml/finding_list.hpp"

namespace skein::profile {

/// Larger files of values are refused: a list of ten thousand sites fits.
inline constexpr std::size_t kLargestValueFile = 1024 * 1024;

/// A value `@FILE` with its file made absolute, so that it means the same wherever it is read:
/// `folder` is what a relative one is relative to. Any other value stays.
std::string with_whole_path(const std::string& value, const std::filesystem::path& folder);

/// `NAME=@FILE`, with the file made absolute from the current folder; any other assignment stays.
std::string assignment_with_whole_path(const std::string& assignment);

/// Of a value `@FILE`, puts the text of the file, whose path is absolute, in the value's place, and
/// `@` in place of `@@` at its beginning. A file that cannot be used is a finding, and leaves the
/// value empty.
void read_value_file(Setting& setting, FindingList& findings);

}  // namespace skein::profile
