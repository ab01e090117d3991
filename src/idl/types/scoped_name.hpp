#pragma once

#include <cstdint>
#include <string>
#include <string_view>

/// Scoped names of IDL, `A::B::c`.
namespace skein::idl {

/// The first `count` parts: of `A::B::c` and 2, `A::B`.
std::string first_parts(std::string_view name, std::uint32_t count);
std::string last_part(std::string_view name);
/// What a name stands in; empty for the outermost scope.
std::string scope_of(std::string_view name);
std::string inside(const std::string& scope, const std::string& name);
/// With an underscore before each part that is a keyword of IDL. Throw InvalidArgument for what is
/// no identifier.
std::string escaped(std::string_view part);
std::string escaped_parts(std::string_view name);

}  // namespace skein::idl
