#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace skein {

/// ` (did you mean 'X'?)` for the known name that is nearest to `name` by edit distance (two
/// neighbours that were exchanged are one edit), or an empty text where none is near (more than a
/// third of the letters differ, or more than `most`).
std::string suggestion(std::string_view name, std::span<const std::string> known,
                       std::size_t most = SIZE_MAX);

}  // namespace skein
