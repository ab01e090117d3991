#pragma once

#include <string>
#include <string_view>

#include "skein/types.idl.hpp"

namespace skein::idl {

/// How IDL spells a basic type. Throws std::out_of_range for other kinds.
std::string_view primitive_name(types::Kind kind);

/// For people, with an article: `a sequence<double>`, `an @appendable struct geo::Pose`.
std::string in_words(types::Kind primitive);
std::string in_words(const types::Type& type);
std::string in_words(const types::Declaration& declaration);

}  // namespace skein::idl
