#include "recording/type_graph.hpp"

#include <algorithm>
#include <vector>

#include "core/printable.hpp"
#include "skein/error.hpp"

namespace skein::recording {
namespace {

using namespace types;

void collect(const Type& type, std::set<std::string>& names) {
  if (type.kind == Kind::Declared) names.insert(type.name);
  for (const Type& element : type.elements) collect(element, names);
}

bool is_optional_inside(const Type& type) {
  return type.kind == Kind::OptionalMember ||
         std::ranges::any_of(type.elements, is_optional_inside);
}

bool grows(const Declaration& declaration) {
  return declaration.extensibility != Extensibility::Final ||
         std::ranges::any_of(declaration.members,
                             [](const Member& member) { return is_optional_inside(member.type); });
}

/// As the values of an enumeration that says nothing: 0, 1, 2, … in 32 bits.
bool is_counted(const Declaration& enumeration) {
  std::int64_t next = 0;
  return enumeration.bits == 32 && std::ranges::all_of(enumeration.values, [&](const Value& value) {
           return value.value == next++;
         });
}

}  // namespace

std::set<std::string> names_in(const Type& type) {
  std::set<std::string> names;
  collect(type, names);
  return names;
}

TypeGraph::TypeGraph(const TypeSystem& types) {
  for (const Declaration& declaration : types.declarations) {
    declarations_.try_emplace(declaration.name, &declaration);
  }
}

const Declaration& TypeGraph::at(const std::string& name) const {
  const auto found = declarations_.find(name);
  if (found == declarations_.end()) {
    throw InvalidArgument("the type '" + printable(name) + "' is named, but not declared");
  }
  return *found->second;
}

std::set<std::string> TypeGraph::parts(const std::string& root) const {
  std::set<std::string> parts{root};
  std::vector<std::string> open{root};
  while (!open.empty()) {
    const Declaration& declaration = at(open.back());
    open.pop_back();
    for (const Member& member : declaration.members) {
      for (const std::string& name : names_in(member.type)) {
        if (parts.insert(name).second) open.push_back(name);
      }
    }
    for (const Type& discriminator : declaration.discriminator) {
      for (const std::string& name : names_in(discriminator)) parts.insert(name);
    }
  }
  return parts;
}

Representation TypeGraph::representation(const std::string& root) const {
  const auto all = parts(root);
  if (std::ranges::none_of(all, [this](const auto& name) { return grows(at(name)); })) {
    return Representation::Xcdr1;
  }
  switch (at(root).extensibility) {
    case Extensibility::Appendable:
      return Representation::Xcdr2Delimited;
    case Extensibility::Mutable:
      return Representation::Xcdr2ParameterList;
    default:
      return Representation::Xcdr2Plain;
  }
}

bool is_delimited(const Type& element, const TypeGraph& graph) {
  switch (element.kind) {
    case Kind::String:
    case Kind::WideString:
    case Kind::Sequence:
    case Kind::Map:
    case Kind::Array:
    case Kind::Reference:
      return true;
    case Kind::Declared: {
      const Declaration& declaration = graph.at(element.name);
      const bool is_number =
          declaration.kind == DeclarationKind::Bitmask ||
          declaration.kind == DeclarationKind::Bitset ||
          (declaration.kind == DeclarationKind::Enumeration && !is_counted(declaration));
      return !is_number;
    }
    default:
      return false;
  }
}

}  // namespace skein::recording
