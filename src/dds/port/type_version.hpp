#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "skein/detail/qos.hpp"

namespace skein::dds {

/// What discovery carries of one endpoint stays below 2 KiB.
inline constexpr std::size_t kMostMembers = 128;
inline constexpr std::size_t kLargestVersion = 2000;

/// A version as an endpoint's USER_DATA carries it: "SKT2", then little-endian and without padding
/// the signature, in one octet how many members there are, for each its type, member, digest and
/// whether it is required, and the text. Nothing for a version that is not told. Of its members the
/// first kMostMembers; of the text the first lines, as long as all stays within kLargestVersion.
std::vector<std::uint8_t> to_user_data(const TypeVersion& version);

/// Not told where the data is another's, or malformed.
TypeVersion from_user_data(std::span<const std::uint8_t> data);

}  // namespace skein::dds
