#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

#include "skein/types.idl.hpp"

namespace skein::idl {

/// A kind of type that takes other types, or a bound. If no source treats a kind by itself, a value
/// is one of each type that it takes: one after the other in CDR, an object in JSON.
struct TemplateKind {
  types::Kind kind{};
  std::string_view keyword{};  ///< Of IDL, before `<`; empty if IDL writes the type otherwise.
  std::size_t types = 0;       ///< So many it takes.
  bool holds_all = false;      ///< Whether a value always contains one of each of them.
  std::string_view object{};   ///< The word for its object in JSON, for messages.
  std::array<std::string_view, 2> names{};  ///< Of that object's members.
};

inline constexpr TemplateKind kTemplateKinds[] = {
    {types::Kind::String, "string"},
    {types::Kind::WideString, "wstring"},
    {types::Kind::Sequence, "sequence", 1},
    {types::Kind::Array, "", 1, true},
    {types::Kind::Map, "map", 2, false, "a pair of a map", {"key", "value"}},
    {types::Kind::OptionalMember, "", 1},
};
inline constexpr TemplateKind kNoTemplate{};

constexpr const TemplateKind& template_of(types::Kind kind) {
  for (const TemplateKind& each : kTemplateKinds) {
    if (each.kind == kind) return each;
  }
  return kNoTemplate;
}

/// `map<long, string, 9>`, if the kind has a keyword. `text_of` is asked for each type that it
/// takes. Throws std::out_of_range if the description lacks one.
template <class TextOf>
std::string template_text(const types::Type& type, const TextOf& text_of) {
  const TemplateKind& kind = template_of(type.kind);
  std::string given;
  const auto add = [&](const std::string& each) { given += (given.empty() ? "" : ", ") + each; };
  for (std::size_t i = 0; i < kind.types; ++i) add(text_of(type.elements.at(i)));
  if (type.bound > 0) add(std::to_string(type.bound));
  return std::string(kind.keyword) + (given.empty() ? "" : "<" + given + ">");
}

}  // namespace skein::idl
