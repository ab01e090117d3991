#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace skein {

/// So much of a name that came from the network is shown.
inline constexpr std::size_t kLongestShownName = 256;

/// Text that came from elsewhere (the network, a file, another program) as it may be written to a
/// terminal, on one line. Control characters (C0 without the tab, DEL, C1), those that turn the
/// direction of writing, line separators and bytes that are no UTF-8 become `\xNN`, byte by byte; a
/// backslash stays. Of a text longer than `longest` bytes the beginning is shown, and its size.
std::string printable(std::string_view text, std::size_t longest = kLongestShownName);

}  // namespace skein
