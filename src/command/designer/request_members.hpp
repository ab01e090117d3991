#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "skein/error.hpp"

namespace skein::command::designer {

/// A request of a page, as JSON. Throws InvalidArgument for other values than objects.
inline nlohmann::json request_of(std::string_view text) {
  auto request = nlohmann::json::parse(text, nullptr, false);
  if (!request.is_object()) throw InvalidArgument("a request is a JSON object");
  return request;
}

/// A member of a request. These throw InvalidArgument if it is not there, or another kind.
inline const nlohmann::json& member(const nlohmann::json& request, const char* name) {
  const auto found = request.find(name);
  if (found == request.end())
    throw InvalidArgument(std::string("the request has no member '") + name + "'");
  return *found;
}

inline std::string text_of(const nlohmann::json& request, const char* name) {
  const nlohmann::json& value = member(request, name);
  if (value.is_string()) return value.get<std::string>();
  throw InvalidArgument(std::string("the member '") + name + "' is no text");
}

inline std::vector<std::string> texts_of(const nlohmann::json& request, const char* name) {
  const nlohmann::json& value = member(request, name);
  if (value.is_array() && std::ranges::all_of(value, &nlohmann::json::is_string))
    return value.get<std::vector<std::string>>();
  throw InvalidArgument(std::string("the member '") + name + "' is no list of texts");
}

inline double number_of(const nlohmann::json& request, const char* name, double most) {
  const nlohmann::json& value = member(request, name);
  if (value.is_number() && std::abs(value.get<double>()) <= most) return value.get<double>();
  throw InvalidArgument(std::string("the member '") + name + "' is no number, or too great");
}

inline std::uint64_t count_of(const nlohmann::json& request, const char* name) {
  const nlohmann::json& value = member(request, name);
  if (value.is_number_unsigned()) return value.get<std::uint64_t>();
  throw InvalidArgument(std::string("the member '") + name + "' is no whole number");
}

/// Farther away nobody finds a box again.
inline constexpr double kFarthest = 1e6;

}  // namespace skein::command::designer
