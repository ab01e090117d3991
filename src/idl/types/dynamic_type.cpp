#include "dynamic_type.hpp"

#include <algorithm>
#include <set>

#include "constant_text.hpp"
#include "core/suggestion.hpp"
#include "description_limits.hpp"
#include "primitive_kind.hpp"
#include "skein/error.hpp"
#include "template_kinds.hpp"

namespace skein::idl {
namespace {

using types::Declaration;
using types::DeclarationKind;
using types::Extensibility;
using types::Kind;

[[noreturn]] void refuse(const std::string& what, const std::string& why) {
  throw InvalidArgument("the description of '" + what + "' makes no sense: " + why);
}

void demand(bool holds, const std::string& what, const char* why) {
  if (!holds) refuse(what, why);
}

bool is_numbered(const Declaration& declaration) {
  return declaration.kind == DeclarationKind::Enumeration ||
         declaration.kind == DeclarationKind::Bitmask ||
         declaration.kind == DeclarationKind::Bitset;
}

void check_numbers(const Declaration& declaration) {
  const std::string& name = declaration.name;
  const unsigned bits = declaration.bits;
  const bool enumeration = declaration.kind == DeclarationKind::Enumeration;
  demand(bits == 8 || bits == 16 || bits == 32 || (bits == 64 && !enumeration), name,
         "no such number of bits");
  demand(!enumeration || !declaration.values.empty(), name, "an enumeration of nothing");
  unsigned used = 0;
  for (const types::BitField& field : declaration.fields) {
    demand(field.width > 0 && field.width <= 64, name, "a bit field without bits, or of too many");
    demand(field.kind == Kind::Boolean ||
               (field.kind >= Kind::Int8 && field.kind <= Kind::UnsignedLongLong),
           name, "a bit field that is no number");
    used += field.width;
  }
  demand(used <= bits, name, "its fields do not fit");
  if (declaration.kind != DeclarationKind::Bitmask) return;
  for (const types::Value& flag : declaration.values) {
    demand(flag.value >= 0 && flag.value < static_cast<std::int64_t>(bits), name,
           "a bit that it has not");
  }
}

bool may_discriminate(const DynamicType& type) {
  return (type.kind <= Kind::UnsignedLongLong) || type.is(DeclarationKind::Enumeration);
}

bool labels_are_values(const Declaration& declaration, const DynamicType& discriminator) {
  if (!discriminator.is(DeclarationKind::Enumeration)) return true;
  const auto& values = discriminator.declaration->values;
  return std::ranges::all_of(declaration.members, [&](const types::Member& member) {
    return std::ranges::all_of(member.labels, [&](std::int64_t label) {
      return std::ranges::count(values, label, &types::Value::value) > 0;
    });
  });
}

bool is_counted(const Declaration& enumeration) {
  std::int64_t next = 0;
  return enumeration.bits == 32 &&
         std::ranges::all_of(enumeration.values,
                             [&](const types::Value& each) { return each.value == next++; });
}

/// Whether `holds` is true of `start` or of a type that it leads to; `next` appends to a list where
/// a type leads. Goes by a list, since types may lead to each other in a long row.
template <class Next, class Holds>
bool leads_to(const DynamicType& start, const Next& next, const Holds& holds) {
  std::vector<const DynamicType*> left{&start};
  std::set<const DynamicType*> seen;
  while (!left.empty()) {
    const DynamicType& type = *left.back();
    left.pop_back();
    if (type.kind == Kind::Declared && !seen.insert(&type).second) continue;
    if (holds(type)) return true;
    next(type, left);
  }
  return false;
}

/// Whether a value of the type always contains one of `goal`.
bool contains(const DynamicType& type, const DynamicType& goal) {
  const auto always = [](const DynamicType& each, std::vector<const DynamicType*>& parts) {
    if (template_of(each.kind).holds_all) {
      parts.insert(parts.end(), each.elements.begin(), each.elements.end());
    }
    if (each.kind != Kind::Declared) return;
    const bool one = each.is(DeclarationKind::Union);
    for (const DynamicType::Member& member : each.members) {
      parts.push_back(member.type);
      if (one) return;
    }
  };
  return leads_to(type, always, [&](const DynamicType& each) { return &each == &goal; });
}

/// Whether it contains what is @appendable, @mutable or @optional.
bool grows(const DynamicType& type) {
  const auto any = [](const DynamicType& each, std::vector<const DynamicType*>& parts) {
    parts.insert(parts.end(), each.elements.begin(), each.elements.end());
    for (const DynamicType::Member& member : each.members) parts.push_back(member.type);
  };
  return leads_to(type, any, [](const DynamicType& each) {
    return each.kind == Kind::OptionalMember ||
           (each.kind == Kind::Declared && each.declaration->extensibility != Extensibility::Final);
  });
}

}  // namespace

const DynamicType::Member* DynamicType::selected(std::int64_t label) const {
  const Member* by_default = nullptr;
  for (const Member& member : members) {
    if (std::ranges::find(member.described->labels, label) != member.described->labels.end()) {
      return &member;
    }
    if (has(member.described->flags, types::MemberFlags::by_default)) by_default = &member;
  }
  return by_default;
}

const DynamicType::Member& DynamicType::initial_member() const {
  const auto ends = std::ranges::find_if(
      members, [this](const Member& member) { return !contains(*member.type, *this); });
  return ends == members.end() ? members.front() : *ends;
}

// The first value, in the order in which generated code looks for one, that no case has.
std::int64_t DynamicType::label_of(const Member& member) const {
  if (!member.described->labels.empty()) return member.described->labels.front();
  const auto is_free = [this](std::int64_t label) {
    return std::ranges::none_of(members, [&](const Member& each) {
      return std::ranges::count(each.described->labels, label) > 0;
    });
  };
  if (discriminator->is(DeclarationKind::Enumeration)) {
    for (const types::Value& value : discriminator->declaration->values) {
      if (is_free(value.value)) return value.value;
    }
    return discriminator->declaration->values.front().value;
  }
  switch (discriminator->kind) {
    case Kind::Boolean:
      return is_free(0) ? 0 : 1;
    case Kind::Char:
    case Kind::WideChar:
    case Kind::Octet: {
      std::int64_t label = 255;
      while (label > 0 && !is_free(label)) --label;
      return label;
    }
    default:
      break;
  }
  const auto bits = 8 * size_of(discriminator->kind);
  std::int64_t label = is_unsigned(discriminator->kind)
                           ? static_cast<std::int64_t>(~std::uint64_t{0} >> (64 - bits))
                           : static_cast<std::int64_t>(~std::uint64_t{0} << (bits - 1));
  const int step = is_unsigned(discriminator->kind) ? -1 : 1;
  while (!is_free(label)) label += step;
  return label;
}

bool DynamicType::is_object() const {
  if (kind == Kind::OptionalMember) return elements[0]->is_object();
  if (elements.size() > 1) return kind != Kind::Map;
  return kind == Kind::Reference || (kind == Kind::Declared && !is(DeclarationKind::Enumeration) &&
                                     !is(DeclarationKind::Bitmask));
}

bool DynamicType::is_delimited_element() const {
  if (kind <= Kind::LongDouble) return false;
  if (kind != Kind::Declared || !is_numbered(*declaration)) return true;
  return declaration->kind == DeclarationKind::Enumeration && is_counted(*declaration);
}

DynamicTypes::DynamicTypes(types::TypeSystem described) : described_(std::move(described)) {
  check_limits(described_);
  for (const Declaration& declaration : described_.declarations) {
    DynamicType& type = types_.emplace_back();
    type.declaration = &declaration;
    type.system = &described_;
    demand(declared_.emplace(declaration.name, &type).second, declaration.name,
           "it is declared twice");
  }
  for (const bool numbered : {true, false}) {  // members' initial values name enumerators
    for (const auto& [name, type] : declared_) {
      if (is_numbered(*type->declaration) == numbered) complete(*type, *type->declaration);
    }
  }
  for (const auto& [name, type] : declared_) choose_representation(*type);
}

const DynamicType& DynamicTypes::type(const std::string& name) const {
  if (const auto found = declared_.find(name); found != declared_.end()) return *found->second;
  std::vector<std::string> known;
  for (const auto& [each, type] : declared_) known.push_back(each);
  throw InvalidArgument("no type '" + name + "' is described" + suggestion(name, known));
}

const DynamicType& DynamicTypes::add_struct(const std::string& name,
                                            std::vector<types::Member> members) {
  Declaration& declaration = added_.emplace_back();
  declaration.name = name;
  declaration.members = std::move(members);
  DynamicType& type = types_.emplace_back();
  type.declaration = &declaration;
  type.system = &described_;
  complete(type, declaration);
  choose_representation(type);
  return type;
}

const DynamicType* DynamicTypes::resolve(const types::Type& type) {
  if (type.kind == Kind::Declared) {
    const auto found = declared_.find(type.name);
    if (found == declared_.end()) refuse(type.name, "it is named, but not declared");
    return found->second;
  }
  demand(type.elements.size() == template_of(type.kind).types,
         std::string(types::to_string(type.kind)), "it lacks what its kind has");
  demand(type.kind != Kind::Array || type.bound > 0, "array", "an array of nothing");
  DynamicType resolved;
  resolved.kind = type.kind;
  resolved.bound = type.bound;
  for (const types::Type& element : type.elements) resolved.elements.push_back(resolve(element));
  if (type.kind == Kind::Map) {
    const DynamicType& key = *resolved.elements.front();
    demand(key.kind == Kind::String || key.kind == Kind::WideString || may_discriminate(key), "map",
           "its key is of no kind that can be one");
  }
  return &types_.emplace_back(std::move(resolved));
}

void DynamicTypes::complete(DynamicType& type, const Declaration& declaration) {
  if (is_numbered(declaration)) check_numbers(declaration);
  for (const types::Value& value : declaration.values) {
    type.names.push_back(value.name);
    if (declaration.kind == DeclarationKind::Bitmask) {
      type.flags.push_back({value.name, std::uint64_t{1} << value.value});
    }
  }
  for (const types::BitField& field : declaration.fields) {
    if (!field.name.empty()) type.names.push_back(field.name);
  }
  if (is_numbered(declaration)) return;
  if (declaration.kind == DeclarationKind::Union) {
    demand(declaration.discriminator.size() == 1 && !declaration.members.empty(), declaration.name,
           "a union without discriminator or members");
    type.discriminator = resolve(declaration.discriminator.front());
    demand(may_discriminate(*type.discriminator), declaration.name,
           "its discriminator is of no kind that can be one");
    demand(labels_are_values(declaration, *type.discriminator), declaration.name,
           "a label that is no value of its discriminator");
  }
  complete_members(type, declaration);
}

void DynamicTypes::complete_members(DynamicType& type, const Declaration& declaration) {
  for (const types::Member& member : declaration.members) {
    const DynamicType* const of = resolve(member.type);
    type.names.push_back(member.name);
    type.members.push_back(
        {&member, of, declaration.name + "." + member.name, json_of_constant(*of, member.initial)});
  }
}

void DynamicTypes::choose_representation(DynamicType& type) const {
  if (!grows(type)) return;
  switch (type.declaration->extensibility) {
    case Extensibility::Final:
      type.representation = Representation::Xcdr2Plain;
      break;
    case Extensibility::Appendable:
      type.representation = Representation::Xcdr2Delimited;
      break;
    case Extensibility::Mutable:
      type.representation = Representation::Xcdr2ParameterList;
      break;
  }
}

}  // namespace skein::idl
