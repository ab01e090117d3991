#pragma once

#include <nlohmann/json.hpp>

#include "skein/detail/type_support.hpp"

namespace skein::command {

/// JSON for stdout, which drives no terminal, indented or in one line. A line break ends it.
void print_json(const nlohmann::ordered_json& value, bool indented);

/// A value of an IDL type.
template <typename T>
nlohmann::ordered_json json_of(const T& value) {
  return nlohmann::ordered_json::parse(idl::to_json(value));
}

}  // namespace skein::command
