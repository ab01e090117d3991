#pragma once

#include <string>

namespace skein::idl {

struct DynamicType;

/// The JSON of a constant as IDL writes it (`5`, `TRUE`, `"text"`, `L'\u00e9'`, `RED`); empty for
/// an empty text. Throws InvalidArgument if it is none of the type.
std::string json_of_constant(const DynamicType& type, const std::string& constant);

}  // namespace skein::idl
