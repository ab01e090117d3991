#pragma once

#include <string>
#include <string_view>

#include "mission/xml/finding.hpp"

namespace skein::profile {

/// Where in `text` the byte at `offset` stands.
SourcePosition position_at(std::string_view text, std::size_t offset, const std::string& file);

/// Refuses text that is no UTF-8, or holds a NUL or another control character than tabs and line
/// breaks. Throws DescriptionError with the first of them.
void demand_utf8_text(std::string_view text, const std::string& file);

/// Refuses, before a parser sees it, text that is no XML in UTF-8 or that a lenient parser would
/// read otherwise than it is written: other encodings, NUL and control characters, a document type
/// with declarations of its own (entity bombs), and references to entities that XML does not have.
/// Throws DescriptionError with the first of them.
void demand_plain_xml_text(std::string_view text, const std::string& file);

}  // namespace skein::profile
