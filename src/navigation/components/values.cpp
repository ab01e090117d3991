#include "values.hpp"

#include <fmt/core.h>

#include <charconv>

#include "profile/dictionary.hpp"
#include "skein/error.hpp"

namespace skein::navigation {

double number_of(const ParameterValues& values, const std::string& name, double otherwise) {
  const auto found = values.find(name);
  if (found == values.end()) return otherwise;
  const std::string& text = found->second;
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc() && end == text.data() + text.size()) return value;
  throw InvalidArgument(fmt::format("parameter '{}' is '{}', which is not a number", name, text));
}

std::optional<Duration> duration_of(const ParameterValues& values, const std::string& name) {
  const auto found = values.find(name);
  if (found == values.end()) return std::nullopt;
  try {
    return std::chrono::duration_cast<Duration>(profile::parse_duration(found->second, "ms"));
  } catch (const InvalidArgument& error) {
    throw InvalidArgument(fmt::format("parameter '{}': {}", name, error.what()));
  }
}

}  // namespace skein::navigation
