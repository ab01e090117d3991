#include "idl/encode_value.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

namespace skein::idl {
namespace {

/// As people write it: `zones/1/name` is `zones[1].name`.
std::string member_of(const std::string& pointer) {
  std::string member;
  for (std::size_t at = 1; at < pointer.size();) {
    const std::size_t end = std::min(pointer.find('/', at), pointer.size());
    const std::string step = pointer.substr(at, end - at);
    const bool index = step.find_first_not_of("0123456789") == std::string::npos;
    member += index ? "[" + step + "]" : (member.empty() ? "" : ".") + step;
    at = end + 1;
  }
  return member;
}

std::string place_of_zero(const TypeSupport& type, const void* value) {
  const auto json = nlohmann::json::parse(type.to_json(value), nullptr, false);
  if (json.is_discarded()) return {};
  const auto flat = json.flatten();
  for (const auto& [pointer, each] : flat.items()) {
    if (!each.is_string()) continue;
    if (each.get_ref<const std::string&>().find('\0') == std::string::npos) continue;
    return " (in '" + member_of(pointer) + "')";
  }
  return {};
}

}  // namespace

ZeroByte::ZeroByte()
    : InvalidArgument("text with a zero byte cannot travel as an IDL string; use sequence<octet>") {
}

void encode_value(const TypeSupport& type, const void* value, Bytes& message) {
  try {
    type.encode(value, message);
  } catch (const ZeroByte& error) {
    throw InvalidArgument(error.what() + place_of_zero(type, value));
  }
}

}  // namespace skein::idl
