#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "skein/detail/operation.hpp"

namespace skein::idl {

/// The type and all that it names in IDL, for people: each line without indentation; empty for a
/// type that does not describe itself.
std::string type_text(const TypeSupport& type);

/// What the first line in which two such texts differ says on either side; nothing where what is
/// known of both is the same.
std::optional<std::pair<std::string, std::string>> difference_of_texts(std::string_view first,
                                                                       std::string_view second);

}  // namespace skein::idl
