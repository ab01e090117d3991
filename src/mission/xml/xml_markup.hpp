#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "mission/xml/finding.hpp"

namespace skein::profile {

/// What a parser found no well-formed XML: the first mistake that a person would call one, at the
/// place where it was made. A quote that is missing, for example, is seen by a parser only where
/// the next one stands. Nothing where it is another kind of mistake.
std::optional<Finding> find_markup_error(std::string_view text, const std::string& file);

}  // namespace skein::profile
