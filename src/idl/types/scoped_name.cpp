#include "scoped_name.hpp"

#include <algorithm>
#include <array>
#include <cctype>

#include "skein/error.hpp"
#include "template_kinds.hpp"

namespace skein::idl {
namespace {

// OMG IDL 4.2, 7.2.4, but for templates; collisions are found without regard to case.
constexpr auto kKeywords = std::to_array<std::string_view>(
    {"abstract",    "alias",      "any",     "attribute", "bitfield",   "bitmask",    "bitset",
     "boolean",     "case",       "char",    "component", "connector",  "const",      "consumes",
     "context",     "custom",     "default", "double",    "emits",      "enum",       "eventtype",
     "exception",   "factory",    "false",   "finder",    "fixed",      "float",      "getraises",
     "home",        "import",     "in",      "inout",     "int16",      "int32",      "int64",
     "int8",        "interface",  "local",   "long",      "manages",    "mirrorport", "module",
     "multiple",    "native",     "object",  "octet",     "oneway",     "out",        "port",
     "porttype",    "primarykey", "private", "provides",  "public",     "publishes",  "raises",
     "readonly",    "setraises",  "short",   "struct",    "supports",   "switch",     "true",
     "truncatable", "typedef",    "typeid",  "typename",  "typeprefix", "uint16",     "uint32",
     "uint64",      "uint8",      "union",   "unsigned",  "uses",       "valuebase",  "valuetype",
     "void",        "wchar"});
static_assert(std::ranges::is_sorted(kKeywords));

constexpr std::string_view kSeparator = "::";

}  // namespace

std::string first_parts(std::string_view name, std::uint32_t count) {
  std::size_t end = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto found = name.find(kSeparator, end + (i > 0 ? kSeparator.size() : 0));
    if (found == std::string_view::npos) return std::string(name);
    end = found;
  }
  return std::string(name.substr(0, end));
}

std::string last_part(std::string_view name) {
  const auto found = name.rfind(kSeparator);
  return std::string(found == std::string_view::npos ? name : name.substr(found + 2));
}

std::string scope_of(std::string_view name) {
  const auto found = name.rfind(kSeparator);
  return std::string(found == std::string_view::npos ? "" : name.substr(0, found));
}

std::string inside(const std::string& scope, const std::string& name) {
  return scope.empty() ? name : scope + "::" + name;
}

std::string escaped(std::string_view part) {
  const auto fits = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
  };
  if (part.empty() || !std::ranges::all_of(part, fits)) {
    throw InvalidArgument("'" + std::string(part) + "' is no identifier of IDL");
  }
  std::string lower(part);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  const bool is_keyword = std::ranges::binary_search(kKeywords, lower) ||
                          std::ranges::count(kTemplateKinds, lower, &TemplateKind::keyword) > 0;
  return (is_keyword ? "_" : "") + std::string(part);
}

std::string escaped_parts(std::string_view name) {
  const std::string scope = scope_of(name);
  return scope.empty() ? escaped(name) : escaped_parts(scope) + "::" + escaped(last_part(name));
}

}  // namespace skein::idl
