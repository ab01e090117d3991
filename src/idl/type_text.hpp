#pragma once

#include <string>

#include "skein/detail/operation.hpp"

namespace skein::idl {

/// The type and all that it names in IDL, for people: each line without indentation; empty for a
/// type that does not describe itself.
std::string type_text(const TypeSupport& type);

}  // namespace skein::idl
