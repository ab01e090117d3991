#pragma once

#include <string>
#include <vector>

#include "skein/introspection.idl.hpp"
#include "skein/selection.hpp"

namespace skein {

/// In plain words: `accepted`, `timed out`.
const char* in_words(introspection::Outcome outcome) noexcept;

/// Whether both chose the same for the same reasons and for as long, whatever came of it.
bool same_choice(const introspection::Attempt& one, const introspection::Attempt& other);

/// Makes a record's choices again, from what the record says was known. Returns the attempts with
/// these choices; they equal the record's attempts bit for bit, unless the strategy has changed.
/// Throws InvalidArgument for an unknown strategy and for an inconsistent record.
std::vector<introspection::Attempt> replay(const introspection::Decision& record,
                                           const StrategyFactory& strategies = {});

/// The decision in plain words, in several lines.
std::string explain(const introspection::Decision& record);

}  // namespace skein
