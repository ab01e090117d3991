#include "core/system/interface_name.hpp"

#include <algorithm>
#include <optional>
#include <vector>

#include "skein/error.hpp"

namespace skein {
namespace {

constexpr std::string_view kRepositoryPrefix = "IDL:";
constexpr std::string_view kWhiteSpace = " \t\r\n";

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

bool is_identifier(std::string_view text) {
  if (text.empty() || !(is_letter(text.front()) || text.front() == '_')) return false;
  return std::all_of(text.begin(), text.end(),
                     [](char c) { return is_letter(c) || is_digit(c) || c == '_'; });
}

bool is_version(std::string_view text) {
  const auto dot = text.find('.');
  if (dot == 0 || dot == std::string_view::npos || dot + 1 == text.size()) return false;
  return std::all_of(text.begin(), text.end(), [](char c) { return is_digit(c) || c == '.'; }) &&
         text.find('.', dot + 1) == std::string_view::npos;
}

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(kWhiteSpace);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kWhiteSpace) - first + 1);
}

std::string_view without_version(std::string_view text) {
  const auto colon = text.rfind(':');
  const bool versioned = colon != std::string_view::npos && is_version(text.substr(colon + 1));
  return versioned ? text.substr(0, colon) : text;
}

/// The identifiers of a name, outermost first; nothing if `name` is no interface name.
std::optional<std::vector<std::string_view>> maybe_parts(std::string_view name) {
  name = trimmed(name);
  if (name.substr(0, kRepositoryPrefix.size()) == kRepositoryPrefix) {
    name = without_version(name.substr(kRepositoryPrefix.size()));
  }
  const bool slashes = name.find('/') != std::string_view::npos;
  const std::string_view separator = slashes ? "/" : "::";
  if (!slashes && name.substr(0, 2) == separator) name.remove_prefix(2);
  std::vector<std::string_view> parts;
  while (true) {
    const auto end = name.find(separator);
    parts.push_back(name.substr(0, end));
    if (!is_identifier(parts.back())) return std::nullopt;
    if (end == std::string_view::npos) return parts;
    name.remove_prefix(end + separator.size());
  }
}

std::vector<std::string_view> parts_of(std::string_view name) {
  if (auto parts = maybe_parts(name)) return *std::move(parts);
  constexpr std::size_t kShown = 80;
  throw InvalidArgument("\"" + std::string(trimmed(name).substr(0, kShown)) +
                        "\" is no interface name; write it like IDL:AE_navigator/IPlanner or "
                        "AE_navigator::IPlanner");
}

std::string joined(const std::vector<std::string_view>& parts, std::string_view separator) {
  std::string text(parts.front());
  for (auto part = parts.begin() + 1; part != parts.end(); ++part)
    text.append(separator).append(*part);
  return text;
}

}  // namespace

std::string canonical_interface_name(std::string_view name) { return joined(parts_of(name), "/"); }

bool is_interface_name(std::string_view name) noexcept { return maybe_parts(name).has_value(); }

bool same_interface(std::string_view left, std::string_view right) {
  return parts_of(left) == parts_of(right);
}

std::string short_interface_name(std::string_view name) {
  return std::string(parts_of(name).back());
}

bool is_built_in_interface(std::string_view canonical_name) noexcept {
  return canonical_name.starts_with("skein/");
}

std::string scoped_interface_name(std::string_view name) { return joined(parts_of(name), "::"); }

}  // namespace skein
