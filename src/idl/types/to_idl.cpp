#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <span>
#include <stdexcept>
#include <vector>

#include "core/printable.hpp"
#include "flags.hpp"
#include "scoped_name.hpp"
#include "skein/describe.hpp"
#include "skein/error.hpp"
#include "template_kinds.hpp"
#include "type_words.hpp"

namespace skein {
namespace {

using namespace types;
using idl::escaped, idl::escaped_parts, idl::first_parts, idl::has, idl::inside, idl::last_part,
    idl::scope_of;

/// How a declaration names a type: as what must be defined before it; within a sequence or a map,
/// where an announcement does; or as an external member, of which the definition comes later.
enum class Use { Defined, Announced, External };

struct Naming {
  Kind kind;
  std::string name;
  Use use;
};
using Namings = std::vector<Naming>;

void add_names(Namings& names, const Type& type, Use use = Use::Defined) {
  if (type.kind == Kind::Declared || type.kind == Kind::Reference) {
    names.push_back({type.kind, type.name, use});
  }
  const bool apart = type.kind == Kind::Sequence || type.kind == Kind::Map;
  for (const Type& element : type.elements) add_names(names, element, apart ? Use::Announced : use);
}

Namings names_in(const Declaration& declaration) {
  Namings names;
  for (const Type& type : declaration.discriminator) add_names(names, type);
  for (const Member& member : declaration.members) {
    const bool external = has(member.flags, MemberFlags::in_own_memory);
    add_names(names, member.type, external ? Use::External : Use::Defined);
  }
  return names;
}

Namings names_in(const Interface& interface) {
  Namings names;
  for (const Operation& operation : interface.operations) {
    for (const Type& type : operation.result) add_names(names, type);
    for (const Parameter& parameter : operation.parameters) add_names(names, parameter.type);
    for (const std::string& name : operation.raises) {
      names.push_back({Kind::Declared, name, Use::Defined});
    }
  }
  return names;
}

/// Refuses what would end the annotation that it stands in, and what would drive a terminal.
void check_constant(const std::string& constant) {
  const bool quoted = constant.find_first_of("\"'") != std::string::npos;
  const bool ends = !quoted && constant.find_first_of("();{}") != std::string::npos;
  if (!ends && printable(constant, constant.size()) == constant) return;
  throw InvalidArgument("'" + constant + "' is no constant of IDL");
}

const Type& array_element(const Type& type) {
  return type.kind == Kind::Array ? array_element(type.elements.at(0)) : type;
}

/// Writes a type system. A *unit* is what stands directly in a module: a type, or an interface,
/// struct or union with the types that are declared inside it.
class Writer {
 public:
  explicit Writer(const TypeSystem& types) {
    for (const Declaration& declaration : types.declarations) {
      enter(declaration.name, declaration.modules);
      declarations_[declaration.name] = &declaration;
      units_[first_parts(declaration.name, declaration.modules + 1)].push_back(&declaration);
      for (const auto& [kind, name, use] : names_in(declaration)) {
        if (use == Use::External) holders_[name].push_back(declaration.name);
      }
      for (const Value& value : declaration.values) {
        if (declaration.kind == DeclarationKind::Enumeration) {
          names_.insert(inside(scope_of(declaration.name), value.name));
        }
      }
    }
    for (const Interface& interface : types.interfaces) {
      enter(interface.name, interface.modules);
      interfaces_[interface.name] = &interface;
      units_[interface.name];
    }
  }

  std::string write() {
    for (const auto& [name, declared] : units_) place(name);
    for (const std::string& unit : order_) write_unit(unit);
    std::vector<Piece> pieces;
    for (const auto& [name, keyword] : announced_) {
      pieces.push_back({scope_of(name), keyword + " " + escaped(last_part(name)) + ";\n"});
    }
    pieces.insert(pieces.end(), pieces_.begin(), pieces_.end());
    return in_modules(pieces);
  }

 private:
  struct Piece {
    std::string module;
    std::string text;
  };

  void enter(const std::string& name, std::uint32_t modules) {
    std::string module;
    for (std::uint32_t count = 1; count <= modules && module != name; ++count) {
      module = first_parts(name, count);
      names_.insert(module);
    }
    names_.insert(name);
  }

  // ---- the order: what must be defined comes first, and external members before their types

  // Goes as deep as types name each other, so it has little on the stack and writes nothing yet.
  void place(const std::string& unit) {
    if (!begun_.insert(unit).second) return;
    for (const Declaration* declaration : units_[unit]) {
      for (const std::string& holder : holders_[declaration->name]) place(unit_of(holder));
      require(names_in(*declaration));
    }
    if (const auto interface = interfaces_.find(unit); interface != interfaces_.end()) {
      for (const std::string& base : interface->second->bases) place(base);
      require(names_in(*interface->second));
    }
    order_.push_back(unit);
    placed_.insert(unit);
  }

  void require(const Namings& names) {
    for (const Naming& naming : names) require(naming);
  }

  void require(const Naming& naming) {
    const auto& [kind, name, use] = naming;
    if (kind == Kind::Reference) {
      announced_[name] = "interface";
      names_.insert(name);
      return;
    }
    const std::string unit = unit_of(name);
    if (use == Use::Defined || unit != name || !keyword_of(name)) place(unit);
    if (placed_.contains(unit) || unit != name) return;
    if (const char* keyword = keyword_of(name)) announced_[name] = keyword;
  }

  /// What may be announced; null for any other type.
  const char* keyword_of(const std::string& name) const {
    const auto kind = declarations_.at(name)->kind;
    return kind == DeclarationKind::Struct  ? "struct"
           : kind == DeclarationKind::Union ? "union"
                                            : nullptr;
  }

  std::string unit_of(const std::string& name) const {
    const auto found = declarations_.find(name);
    if (found == declarations_.end()) {
      throw InvalidArgument("the type '" + name + "' is named, but not declared");
    }
    return first_parts(name, found->second->modules + 1);
  }

  /// The types that are declared inside `outer`, in their order.
  std::vector<const Declaration*> inner(const std::string& outer) {
    std::vector<const Declaration*> ordered;
    std::set<std::string> seen;
    const auto visit = [&](const auto& self, const std::string& name) -> void {
      const auto found = declarations_.find(name);
      if (found == declarations_.end() || scope_of(name) != outer || !seen.insert(name).second) {
        return;
      }
      for (const std::string& holder : holders_[name]) self(self, holder);
      for (const auto& [kind, used, use] : names_in(*found->second)) {
        if (kind != Kind::Declared) continue;
        if (use == Use::Defined || !keyword_of(used)) self(self, used);
      }
      ordered.push_back(found->second);
    };
    for (const auto& [name, declaration] : declarations_) visit(visit, name);
    return ordered;
  }

  /// Those of them that a declaration names before they are defined.
  std::string announcements(const Declaration& declaration) {
    std::string text;
    for (const auto& [kind, name, use] : names_in(declaration)) {
      if (kind != Kind::Declared || scope_of(name) != scope_ || written_.contains(name)) continue;
      const char* keyword = keyword_of(name);
      if (keyword && announced_inside_.insert(name).second) {
        text += std::string(keyword) + " " + escaped(last_part(name)) + ";\n";
      }
    }
    return text;
  }

  // ---- declarations

  void write_unit(const std::string& unit) {
    scope_ = scope_of(unit);
    const bool is_interface = interfaces_.contains(unit) || !declarations_.contains(unit);
    const std::string text =
        is_interface ? interface_text(unit) : definition(*declarations_[unit]) + ";\n";
    pieces_.push_back({scope_of(unit), take_typedefs() + text});
    written_.insert(unit);
  }

  std::string interface_text(const std::string& name) {
    const auto found = interfaces_.find(name);
    const Interface* interface = found == interfaces_.end() ? nullptr : found->second;
    std::string bases;
    for (const std::string& base : interface ? interface->bases : std::vector<std::string>()) {
      bases += (bases.empty() ? " : " : ", ") + relative(base);
    }
    scope_ = name;
    inherits_ = !bases.empty();
    std::string body;
    for (const Declaration* declaration : inner(name)) {
      const std::string announced = announcements(*declaration);
      const std::string text = definition(*declaration) + ";\n";
      body += announced + take_typedefs() + text;
    }
    for (const Operation& operation :
         interface ? interface->operations : std::vector<Operation>()) {
      const std::string text = operation_text(*interface, operation);
      body += take_typedefs() + text;
    }
    inherits_ = false;
    scope_ = scope_of(name);
    return "interface " + escaped(last_part(name)) + bases + " {\n" + body + "};\n";
  }

  std::string definition(const Declaration& declaration) {
    written_.insert(declaration.name);
    switch (declaration.kind) {
      case DeclarationKind::Enumeration:
        return enumeration(declaration);
      case DeclarationKind::Bitmask:
        return bitmask(declaration);
      case DeclarationKind::Bitset:
        return bitset(declaration);
      case DeclarationKind::Union:
        return union_text(declaration);
      default:
        return structure(declaration);
    }
  }

  std::string structure(const Declaration& declaration) {
    const bool exception = declaration.kind == DeclarationKind::Exception;
    const std::string outer = std::exchange(scope_, declaration.name);
    std::string members;
    std::int64_t last = -1;
    for (const Member& member : declaration.members) {
      members += "  " + annotations(member, last) + declarator(member.type, member.name) + ";\n";
      last = member.id;
    }
    scope_ = outer;
    return extensibility(declaration, exception) + (exception ? "exception " : "struct ") +
           escaped(last_part(declaration.name)) + " {\n" + members + "}";
  }

  std::string union_text(const Declaration& declaration) {
    const std::string outer = std::exchange(scope_, declaration.name);
    const Type& discriminator = declaration.discriminator.at(0);
    std::string text = "union " + escaped(last_part(declaration.name)) + " switch (" +
                       type_text(discriminator) + ") {\n";
    std::int64_t last = 0;
    for (const Member& member : declaration.members) {
      text += "  ";
      for (const std::int64_t value : member.labels) {
        text += "case " + label(discriminator, value) + ": ";
      }
      if (has(member.flags, MemberFlags::by_default)) text += "default: ";
      text += annotations(member, last) + declarator(member.type, member.name) + ";\n";
      last = member.id;
    }
    scope_ = outer;
    return extensibility(declaration, false) + text + "}";
  }

  static std::string extensibility(const Declaration& declaration, bool exception) {
    if (declaration.extensibility == Extensibility::Appendable) return "@appendable ";
    if (declaration.extensibility == Extensibility::Mutable) return "@mutable ";
    return exception ? "" : "@final ";
  }

  std::string annotations(const Member& member, std::int64_t last) {
    std::string text;
    if (has(member.flags, MemberFlags::key)) text += "@key ";
    if (member.id != last + 1) text += "@id(" + std::to_string(member.id) + ") ";
    if (has(member.flags, MemberFlags::must_understand) && !has(member.flags, MemberFlags::key)) {
      text += "@must_understand ";
    }
    if (member.type.kind == Kind::OptionalMember) text += "@optional ";
    if (has(member.flags, MemberFlags::in_own_memory)) text += "@external ";
    if (!member.initial.empty()) {
      check_constant(member.initial);
      text += "@default(" + initial(member) + ") ";
    }
    return text;
  }

  /// An enumerator stands for itself where its enumeration stands.
  std::string initial(const Member& member) {
    const Type& type =
        member.type.kind == Kind::OptionalMember ? member.type.elements.at(0) : member.type;
    const auto found = declarations_.find(type.name);
    if (found == declarations_.end() || found->second->kind != DeclarationKind::Enumeration) {
      return member.initial;
    }
    return relative(inside(scope_of(type.name), member.initial));
  }

  std::string enumeration(const Declaration& declaration) {
    std::string text =
        bit_bound(declaration) + "enum " + escaped(last_part(declaration.name)) + " { ";
    std::int64_t next = 0;
    for (const Value& value : declaration.values) {
      if (&value != &declaration.values.front()) text += ", ";
      if (value.name == declaration.initial) text += "@default_literal ";
      if (value.value != next) text += "@value(" + std::to_string(value.value) + ") ";
      text += escaped(value.name);
      next = value.value + 1;
    }
    return text + " }";
  }

  std::string bitmask(const Declaration& declaration) {
    std::string text =
        bit_bound(declaration) + "bitmask " + escaped(last_part(declaration.name)) + " { ";
    for (const Value& value : declaration.values) {
      if (&value != &declaration.values.front()) text += ", ";
      text += "@position(" + std::to_string(value.value) + ") " + escaped(value.name);
    }
    return text + " }";
  }

  static std::string bit_bound(const Declaration& declaration) {
    return declaration.bits == 32 ? "" : "@bit_bound(" + std::to_string(declaration.bits) + ") ";
  }

  std::string bitset(const Declaration& declaration) {
    std::string text = "bitset " + escaped(last_part(declaration.name)) + " {\n";
    for (const BitField& field : declaration.fields) {
      text += "  bitfield<" + std::to_string(field.width) + ", " +
              std::string(idl::primitive_name(field.kind)) + ">";
      text += (field.name.empty() ? "" : " " + escaped(field.name)) + ";\n";
    }
    return text + "}";
  }

  std::string label(const Type& discriminator, std::int64_t value) {
    switch (discriminator.kind) {
      case Kind::Declared:
        return enumerator(discriminator.name, value);
      case Kind::Boolean:
        return value != 0 ? "TRUE" : "FALSE";
      case Kind::Char:
        return "'\\" + digits(value & 0xFF, 8, 3) + "'";
      case Kind::WideChar:
        return "L'\\u" + digits(value & 0xFFFF, 16, 4) + "'";
      case Kind::UnsignedLongLong:
        return std::to_string(static_cast<std::uint64_t>(value));
      default:
        return std::to_string(value);
    }
  }

  std::string enumerator(const std::string& enumeration, std::int64_t value) {
    const auto& values = declarations_.at(enumeration)->values;
    const auto found = std::ranges::find(values, value, &Value::value);
    if (found == values.end()) {
      throw InvalidArgument("the enumeration '" + enumeration + "' has no value " +
                            std::to_string(value) + ", which a union is switched by");
    }
    return relative(inside(scope_of(enumeration), found->name));
  }

  static std::string digits(std::int64_t value, int base, int count) {
    std::string text;
    for (; count > 0; --count, value /= base) text.insert(0, 1, "0123456789abcdef"[value % base]);
    return text;
  }

  // ---- operations

  std::string operation_text(const Interface& interface, const Operation& operation) {
    if (operation.name.starts_with("_get_")) return attribute_text(interface, operation);
    if (operation.name.starts_with("_set_")) return {};
    std::string parameters;
    for (const Parameter& parameter : operation.parameters) {
      constexpr std::array<std::string_view, 3> kDirections{"in ", "out ", "inout "};
      if (!parameters.empty()) parameters += ", ";
      parameters += kDirections.at(static_cast<std::size_t>(parameter.direction));
      parameters += type_text(parameter.type) + " " + escaped(parameter.name);
    }
    const bool one_way = has(operation.flags, OperationFlags::one_way);
    return "  " + marks(operation) + (one_way ? "oneway " : "") +
           (operation.result.empty() ? "void" : type_text(operation.result[0])) + " " +
           escaped(operation.name) + "(" + parameters + ")" + raises(" raises", operation) + ";\n";
  }

  std::string attribute_text(const Interface& interface, const Operation& get) {
    const std::string name = get.name.substr(5);
    const auto set = std::ranges::find(interface.operations, "_set_" + name, &Operation::name);
    const bool readonly = set == interface.operations.end();
    return "  " + marks(get) + (readonly ? "readonly " : "") + "attribute " +
           type_text(get.result.at(0)) + " " + escaped(name) +
           raises(readonly ? " raises" : " getraises", get) +
           (readonly ? "" : raises(" setraises", *set)) + ";\n";
  }

  static std::string marks(const Operation& operation) {
    return std::string(has(operation.flags, OperationFlags::idempotent) ? "@idempotent " : "") +
           (has(operation.flags, OperationFlags::stream) ? "@stream " : "") +
           (has(operation.flags, OperationFlags::optional) ? "@optional " : "");
  }

  std::string raises(const std::string& keyword, const Operation& operation) {
    std::string list;
    for (const std::string& name : operation.raises) {
      list += (list.empty() ? "" : ", ") + relative(name);
    }
    return list.empty() ? "" : keyword + " (" + list + ")";
  }

  // ---- types

  /// A member's type, which stands around its name where it is an array.
  std::string declarator(const Type& type, const std::string& name) {
    if (type.kind == Kind::OptionalMember) return declarator(type.elements.at(0), name);
    std::string sizes;
    for (const Type* each = &type; each->kind == Kind::Array; each = &each->elements.at(0)) {
      sizes += "[" + std::to_string(each->bound) + "]";
    }
    const Type& element = array_element(type);
    const bool is_here = element.kind == Kind::Declared && scope_of(element.name) == scope_ &&
                         declarations_.contains(scope_) && !written_.contains(element.name);
    return (is_here ? definition(*declarations_.at(element.name)) : type_text(element)) + " " +
           escaped(name) + sizes;
  }

  std::string type_text(const Type& type) {
    if (!idl::template_of(type.kind).keyword.empty()) {
      return idl::template_text(type, [this](const Type& each) { return type_text(each); });
    }
    switch (type.kind) {
      case Kind::Array:
        return array_name(type);
      case Kind::Declared:
      case Kind::Reference:
        if (scope_of(type.name) == scope_ && declarations_.contains(scope_) &&
            !written_.contains(type.name)) {
          return definition(*declarations_.at(type.name));
        }
        return relative(type.name);
      default:
        return std::string(idl::primitive_name(type.kind));
    }
  }

  /// IDL has no name for an array where no declarator stands: it needs a typedef.
  std::string array_name(const Type& type) {
    std::string name;
    do {
      name = "Array" + std::to_string(++arrays_);
    } while (
        std::ranges::any_of(names_, [&](const auto& each) { return last_part(each) == name; }));
    const std::string text = "typedef " + declarator(type, name) + ";\n";
    typedefs_ += text;
    return name;
  }

  std::string take_typedefs() { return std::exchange(typedefs_, {}); }

  /// As short as leads to it from the present scope: see OMG IDL 4.2, 7.5.2.
  std::string relative(const std::string& name) const {
    std::string shortest = name;
    for (std::string scope = scope_; !scope.empty(); scope = scope_of(scope)) {
      if (name.starts_with(scope + "::")) {
        shortest = name.substr(scope.size() + 2);
        break;
      }
    }
    const std::string first = first_parts(shortest, 1);
    std::string text;
    for (std::string scope = scope_;; scope = scope_of(scope)) {
      const std::string found = inside(scope, first);
      if (names_.contains(found)) {
        if (found != name.substr(0, name.size() - shortest.size() + first.size())) break;
        if (inherits_) break;  // a base may have it, too
        return escaped_parts(shortest);
      }
      if (scope.empty()) break;
    }
    return "::" + escaped_parts(name);
  }

  /// Neighbours of one module stand in it together.
  static std::string in_modules(const std::vector<Piece>& pieces) {
    std::string text;
    for (std::size_t i = 0; i < pieces.size();) {
      const std::string& module = pieces[i].module;
      std::string content;
      for (; i < pieces.size() && pieces[i].module == module; ++i) content += pieces[i].text;
      text += in_module(module, content);
    }
    return text;
  }

  static std::string in_module(const std::string& module, const std::string& text) {
    if (module.empty()) return text;
    return in_module(scope_of(module),
                     "module " + escaped(last_part(module)) + " {\n" + text + "};\n");
  }

  std::map<std::string, const Declaration*> declarations_;
  std::map<std::string, const Interface*> interfaces_;
  std::map<std::string, std::vector<const Declaration*>> units_;
  std::map<std::string, std::vector<std::string>> holders_;  // who has external members of a type
  std::set<std::string> names_;                              // of all scopes
  std::map<std::string, std::string> announced_;             // units, with their keywords
  std::set<std::string> announced_inside_;                   // types in interfaces
  std::set<std::string> begun_;
  std::set<std::string> placed_;
  std::vector<std::string> order_;  // in which the units can stand
  std::set<std::string> written_;
  std::string scope_;      // of what is written now
  bool inherits_ = false;  // from other interfaces, in whose scopes names are looked for, too
  std::string typedefs_;   // to be written before the present declaration
  unsigned arrays_ = 0;
  std::vector<Piece> pieces_;
};

}  // namespace

std::string to_idl(const TypeSystem& types) {
  try {
    return Writer(types).write();
  } catch (const std::out_of_range&) {
    throw InvalidArgument(
        "a description lacks what its kind has: the element of a sequence, a discriminator, or a "
        "result");
  }
}

}  // namespace skein
