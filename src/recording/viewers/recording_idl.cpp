#include "recording/viewers/recording_idl.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <vector>

#include "core/printable.hpp"
#include "idl/types/dynamic_type.hpp"
#include "idl/types/scoped_name.hpp"
#include "idl/types/template_kinds.hpp"
#include "recording/viewers/viewer_names.hpp"
#include "skein/error.hpp"

namespace skein::recording {
namespace {

using namespace types;
using idl::DynamicType, idl::has;

std::string bound_of(std::uint32_t bound, const char* before, const char* after) {
  return bound == 0 ? "" : before + std::to_string(bound) + after;
}

bool names_any(const DynamicType& type, const std::set<const DynamicType*>& any) {
  return any.contains(&type) || std::ranges::any_of(type.elements, [&](const DynamicType* element) {
           return names_any(*element, any);
         });
}

/// How a type is written where it is used.
struct Spelling {
  std::string type;
  std::string sizes{};         ///< Of an array: `[2][3]`.
  bool is_collection = false;  ///< A sequence or an array.
  bool is_delimited = false;   ///< On the wire, a length in bytes stands before it.
};

/// Viewers' readers differ in which lengths of XCDR2 they read, and which optional members. They
/// agree on @final types of XCDR1. So all types are @final here: what else stands on the wire
/// becomes members of ours, a flag before an optional member a union's discriminator. Types that
/// are @mutable keep that where the whole message is; elsewhere their members' headers are members,
/// too. What cannot be said so, but has a length, becomes octets.
class IdlWriter {
 public:
  explicit IdlWriter(const DynamicType& root) : root_(root) {
    const auto parts = parts_of(root);
    std::vector<const DynamicType*> in_order(parts.begin(), parts.end());
    std::ranges::sort(in_order, {},
                      [](const DynamicType* part) { return part->declaration->name; });
    for (const DynamicType* part : in_order) names_.of_type(*part->declaration);
    check_recursion(parts);
  }

  RecordingIdl write() {
    if (!root_.is(DeclarationKind::Struct) && !root_.is(DeclarationKind::Union)) {
      throw InvalidArgument("'" + printable(root_.declaration->name) +
                            "' is no struct or union: it is no message");
    }
    const std::string type = declared(root_).type;
    while (!open_.empty()) {
      const DynamicType& next = *open_.back();
      open_.pop_back();
      add(names_.of_type(*next.declaration), definition(next));
    }
    return {type, text_};
  }

 private:
  bool is_xcdr2() const { return skein::is_xcdr2(root_.representation); }
  bool keeps_mutable() const { return root_.representation == Representation::Xcdr2ParameterList; }
  bool is_mutable(const DynamicType& type) const {
    return type.declaration->extensibility == Extensibility::Mutable;
  }
  bool is_kept(const DynamicType& type) const { return is_mutable(type) && keeps_mutable(); }

  /// The declared types that it consists of, and itself.
  static std::set<const DynamicType*> parts_of(const DynamicType& root) {
    std::set<const DynamicType*> parts;
    std::vector<const DynamicType*> open{&root};
    while (!open.empty()) {
      const DynamicType& type = *open.back();
      open.pop_back();
      if (type.declaration && !parts.insert(&type).second) continue;
      open.insert(open.end(), type.elements.begin(), type.elements.end());
      for (const DynamicType::Member& member : type.members) open.push_back(member.type);
      if (type.discriminator) open.push_back(type.discriminator);
    }
    return parts;
  }

  // ---- types that contain themselves

  /// The viewer works out each struct before it reads any, unions when it meets one. A type that
  /// contains itself must do so by a union, or by an optional member, which can become one.
  void check_recursion(std::set<const DynamicType*> parts) const {
    const auto is_leaf = [&](const DynamicType* type) {
      if (type->is(DeclarationKind::Union)) return true;
      return std::ranges::none_of(type->members, [&](const DynamicType::Member& member) {
        return !becomes_union(*type, member) && names_any(*member.type, parts);
      });
    };
    while (std::erase_if(parts, is_leaf) > 0) continue;
    if (parts.empty()) return;
    throw InvalidArgument("the type '" + printable((*parts.begin())->declaration->name) +
                          "' contains itself by a sequence, or consists of one that does: viewers "
                          "of recordings cannot decode it");
  }

  bool becomes_union(const DynamicType& type, const DynamicType::Member& member) const {
    return member.type->kind == Kind::OptionalMember && !is_kept(type);
  }

  // ---- declarations

  /// Headers of members that may be missing.
  bool is_opaque(const DynamicType& type) const {
    if (!is_mutable(type) || keeps_mutable()) return false;
    return type.is(DeclarationKind::Union) ||
           std::ranges::any_of(type.members, [](const DynamicType::Member& member) {
             return member.type->kind == Kind::OptionalMember;
           });
  }

  /// A length in bytes stands before it.
  bool has_length(const DynamicType& type) const {
    return type.declaration->extensibility != Extensibility::Final && !is_kept(type);
  }

  std::string definition(const DynamicType& type) {
    if (type.is(DeclarationKind::Enumeration)) return enumeration(*type.declaration);
    return type.is(DeclarationKind::Union) ? union_text(type) : structure(type);
  }

  /// A type, in its modules.
  void add(const std::string& name, const std::string& definition) {
    std::string text = definition + ";\n";
    for (std::string scope = idl::scope_of(name); !scope.empty(); scope = idl::scope_of(scope)) {
      text = "module " + idl::last_part(scope) + " {\n" + text + "};\n";
    }
    text_ += text;
  }

  std::string extensibility(const DynamicType& type) const {
    return is_kept(type) ? "@mutable " : "@final ";
  }

  std::string structure(const DynamicType& type) {
    taken_.clear();
    for (const std::string_view name : type.names) taken_.insert(viewer_member(std::string(name)));
    std::string text;
    if (has_length(type)) text += number("bytes");
    if (type.members.empty()) text += "  octet dummy;\n";  // as on the wire
    for (const DynamicType::Member& member : type.members) text += member_of(type, member);
    return extensibility(type) + "struct " + idl::last_part(names_.of_type(*type.declaration)) +
           " {\n" + text + "}";
  }

  /// A member of ours.
  std::string number(std::string name) {
    while (!taken_.insert(name).second) name += "_";
    return "  unsigned long " + name + ";\n";
  }

  std::string member_of(const DynamicType& outer, const DynamicType::Member& member) {
    const std::string name = viewer_member(member.described->name);
    const bool is_optional = member.type->kind == Kind::OptionalMember;
    const DynamicType& type = is_optional ? *member.type->elements[0] : *member.type;
    const std::string annotations = has(member.described->flags, MemberFlags::key) ? "@key " : "";
    if (is_kept(outer)) {
      return single_member(type, name,
                           annotations + "@id(" + std::to_string(member.described->id) + ") " +
                               (is_optional ? "@optional " : ""));
    }
    if (is_optional) return "  " + annotations + optional(type) + " " + name + ";\n";
    const std::string header =
        is_mutable(outer) ? number("header_of_" + name) + number("length_of_" + name) : "";
    return header + members(type, name, annotations);
  }

  /// A member, and before it the length that it may have.
  std::string members(const DynamicType& type, const std::string& name,
                      const std::string& annotations = {}) {
    const Spelling spelling = spell(type);
    return (spelling.is_delimited ? number("bytes_of_" + name) : "") +
           member_text(spelling, name, annotations);
  }

  /// A member where none of ours can stand before it.
  std::string single_member(const DynamicType& type, const std::string& name,
                            const std::string& annotations = {}) {
    const Spelling spelling = spell(type);
    return member_text(spelling.is_delimited ? Spelling{wrapped(type)} : spelling, name,
                       annotations);
  }

  static std::string member_text(const Spelling& spelling, const std::string& name,
                                 const std::string& annotations) {
    return "  " + annotations + spelling.type + " " + name + spelling.sizes + ";\n";
  }

  std::string enumeration(const Declaration& declaration) {
    const std::string& name = names_.of_type(declaration);
    std::string text = "enum " + idl::last_part(name) + " {";
    for (const Value& value : declaration.values) {
      text += &value == &declaration.values.front() ? " " : ", ";
      text +=
          "@value(" + std::to_string(value.value) + ") " + names_.of_enumerator(name, value.name);
    }
    return text + " }";
  }

  std::string union_text(const DynamicType& type) {
    std::string text = extensibility(type) + "union " +
                       idl::last_part(names_.of_type(*type.declaration)) + " switch (" +
                       switch_type(*type.discriminator) + ") {\n";
    bool has_default = false;
    std::set<std::string> taken;
    for (const DynamicType::Member& member : type.members) {
      for (const std::int64_t value : member.described->labels) {
        text += "  case " + label(*type.discriminator, value) + ":";
      }
      const bool by_default = has(member.described->flags, MemberFlags::by_default);
      if (by_default) text += "  default:";
      has_default = has_default || by_default;
      const std::string name = viewer_member(member.described->name);
      taken.insert(name);
      text += single_member(*member.type, name);
    }
    if (has_default) return text + "}";
    std::string name = "nothing";
    while (taken.contains(name)) name += "_";
    return text + nothing_by_default(name) + "}";
  }

  /// Viewers refuse a union that holds nothing.
  std::string nothing_by_default(const std::string& name) {
    return "  default:  " + helper("Nothing", "@final struct ", " {\n}") + " " + name + ";\n";
  }

  std::string optional(const DynamicType& type) {
    return helper("Optional", "@final union ",
                  " switch (boolean) {\n  case TRUE:" + single_member(type, "value") +
                      nothing_by_default("nothing") + "}");
  }

  std::string switch_type(const DynamicType& type) {
    switch (type.kind) {
      case Kind::Char:
        return "octet";
      case Kind::LongLong:
      case Kind::UnsignedLongLong:
        throw InvalidArgument(
            "a union is switched by a number of 64 bits, by which viewers of recordings find no "
            "case");
      default:
        return spell(type).type;
    }
  }

  static std::string label(const DynamicType& discriminator, std::int64_t value) {
    switch (discriminator.kind) {
      case Kind::Boolean:
        return value != 0 ? "TRUE" : "FALSE";
      case Kind::Char:
        return std::to_string(value & 0xFF);
      case Kind::WideChar:
        return std::to_string(value & 0xFFFF);
      default:
        return std::to_string(value);
    }
  }

  // ---- types of ours

  /// A type of ours with this definition; the same for equal ones.
  std::string helper(const std::string& what, const std::string& before, const std::string& after) {
    const auto [place, is_new] = helpers_.try_emplace(before + after);
    if (is_new) {
      place->second = names_.of_helper(what);
      add(place->second, before + idl::last_part(place->second) + after);
    }
    return place->second;
  }

  /// A struct that holds nothing else: where a collection cannot stand.
  std::string wrapped(const DynamicType& type) {
    return plain_struct("Value", [&] { return members(type, "value"); });
  }

  template <class Members>
  std::string plain_struct(const std::string& what, const Members& members) {
    const auto outer = std::exchange(taken_, {});
    const std::string text = members();
    taken_ = outer;
    return helper(what, "@final struct ", " {\n" + text + "}");
  }

  // ---- types where they are used

  Spelling spell(const DynamicType& type) {
    switch (type.kind) {
      case Kind::String:
        return {.type = "string" + bound_of(type.bound, "<", ">")};
      case Kind::WideString:
        return {.type = "sequence<octet>", .is_collection = true};
      case Kind::LongDouble:
        return {.type = helper("LongDouble", "@final struct ",
                               " {\n  unsigned long long low;\n  unsigned long long high;\n}")};
      case Kind::Reference:
        return {.type = helper("ServiceReference", "@final struct ",
                               " {\n  string interface_name;\n  octet provider[16];\n  string "
                               "instance;\n}")};
      case Kind::Sequence: {
        Spelling spelling = collection_of(*type.elements[0]);
        spelling.type = "sequence<" + spelling.type + bound_of(type.bound, ", ", "") + ">";
        return spelling;
      }
      case Kind::Array: {
        std::string sizes;
        const DynamicType* element = &type;
        for (; element->kind == Kind::Array; element = element->elements[0]) {
          sizes += "[" + std::to_string(element->bound) + "]";
        }
        Spelling spelling = collection_of(*element);
        spelling.sizes = sizes;
        return spelling;
      }
      case Kind::Map:
        return {.type = "sequence<" + pair(type) + bound_of(type.bound, ", ", "") + ">",
                .is_collection = true,
                .is_delimited = is_xcdr2()};
      case Kind::OptionalMember:
        throw InvalidArgument("something is optional that is no member");
      case Kind::Declared:
        return declared(type);
      default:
        return {.type = type.elements.empty() ? primitive(type.kind) : pair(type)};
    }
  }

  /// One of each type that a template takes.
  std::string pair(const DynamicType& type) {
    const auto& names = idl::template_of(type.kind).names;
    return plain_struct("Pair", [&] {
      std::string text;
      for (std::size_t i = 0; i < type.elements.size(); ++i) {
        text += members(*type.elements[i], std::string(names.at(i)));
      }
      return text;
    });
  }

  Spelling collection_of(const DynamicType& element) {
    Spelling spelling = spell(element);
    if (spelling.is_collection) spelling = {.type = wrapped(element)};
    spelling.is_collection = true;
    spelling.is_delimited = is_xcdr2() && element.is_delimited_element();
    return spelling;
  }

  Spelling declared(const DynamicType& type) {
    const Declaration& declaration = *type.declaration;
    switch (declaration.kind) {
      case DeclarationKind::Enumeration: {
        const bool is_negative = std::ranges::any_of(
            declaration.values, [](const Value& value) { return value.value < 0; });
        if (declaration.bits != 32 || is_negative) return {.type = integer(declaration, "")};
        break;
      }
      case DeclarationKind::Bitmask:
      case DeclarationKind::Bitset:
        return {.type = integer(declaration, "u")};
      default:
        if (is_opaque(type)) return {.type = "sequence<octet>", .is_collection = true};
    }
    const std::string& name = names_.of_type(declaration);
    if (begun_.insert(&type).second) open_.push_back(&type);
    if (declaration.kind != DeclarationKind::Union || !has_length(type)) return {.type = name};
    return {.type = helper("Value", "@final struct ",
                           " {\n  unsigned long bytes;\n  " + name + " value;\n}")};
  }

  static std::string integer(const Declaration& declaration, const char* sign) {
    return sign + ("int" + std::to_string(declaration.bits));
  }

  static std::string primitive(Kind kind) {
    constexpr std::array<const char*, 13> kNames{
        "boolean",       "char",      "unsigned short",     "int8",
        "octet",         "short",     "unsigned short",     "long",
        "unsigned long", "long long", "unsigned long long", "float",
        "double"};
    return kNames.at(static_cast<std::size_t>(kind));
  }

  const DynamicType& root_;
  ViewerNames names_;
  std::map<std::string, std::string> helpers_;  // definition → name
  std::set<const DynamicType*> begun_;
  std::vector<const DynamicType*> open_;  // to be defined
  std::set<std::string> taken_;           // names of the members of the present struct
  std::string text_;
};

}  // namespace

RecordingIdl to_recording_idl(const TypeSystem& types, const std::string& root) {
  const idl::DynamicTypes known(types);
  return IdlWriter(known.type(root)).write();
}

}  // namespace skein::recording
