#pragma once

#include <filesystem>
#include <string>

namespace skein::profile {

/// Larger files are refused before they are read: no description that a person writes comes near.
constexpr std::size_t kLargestFile = 8 * 1024 * 1024;

/// The bytes of a regular file. Throws DescriptionError for what is missing, unreadable, no regular
/// file (a pipe would hang, a device never end) or larger than kLargestFile.
std::string read_text_file(const std::filesystem::path& file);

}  // namespace skein::profile
