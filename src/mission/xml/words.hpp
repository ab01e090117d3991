#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace skein::profile {

/// `text` for a message: shortened to a readable length, and as printable() has it.
std::string shortened(std::string_view text);

/// As shortened(), in quotes.
std::string in_quotes(std::string_view text);

/// `did you mean 'x'?`, or `known are "x", "y"` when nothing is near (the first few of many).
/// Long words and the last of very many are not compared, so that hostile text costs little.
std::string remedy_for(std::string_view unknown, const std::vector<std::string_view>& known);

std::string_view trimmed(std::string_view text);

}  // namespace skein::profile
