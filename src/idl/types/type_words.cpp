#include "idl/types/type_words.hpp"

#include <array>

#include "idl/types/template_kinds.hpp"

namespace skein::idl {
namespace {

using namespace types;

constexpr std::array<std::string_view, 14> kPrimitives{"boolean",
                                                       "char",
                                                       "wchar",
                                                       "int8",
                                                       "octet",
                                                       "short",
                                                       "unsigned short",
                                                       "long",
                                                       "unsigned long",
                                                       "long long",
                                                       "unsigned long long",
                                                       "float",
                                                       "double",
                                                       "long double"};

std::string with_article(const std::string& what) {
  const char first = what.starts_with('@') && what.size() > 1 ? what[1] : what.front();
  const bool vowel = std::string_view("aeioAEIO").find(first) != std::string_view::npos;
  return (vowel || what.starts_with("unsigned") ? "an " : "a ") + what;
}

std::string spelled(const Type& type) {
  if (!template_of(type.kind).keyword.empty()) return template_text(type, spelled);
  switch (type.kind) {
    case Kind::Array:
      return spelled(type.elements.at(0)) + "[" +
             (type.bound == 0 ? "" : std::to_string(type.bound)) + "]";
    case Kind::OptionalMember:
      return "optional " + spelled(type.elements.at(0));
    case Kind::Declared:
      return type.name;
    case Kind::Reference:
      return "reference to " + type.name;
    default:
      return std::string(primitive_name(type.kind));
  }
}

const char* keyword_of(DeclarationKind kind) {
  switch (kind) {
    case DeclarationKind::Struct:
      return "struct";
    case DeclarationKind::Exception:
      return "exception";
    case DeclarationKind::Union:
      return "union";
    case DeclarationKind::Enumeration:
      return "enum";
    case DeclarationKind::Bitmask:
      return "bitmask";
    case DeclarationKind::Bitset:
      break;
  }
  return "bitset";
}

const char* annotation_of(Extensibility extensibility) {
  if (extensibility == Extensibility::Appendable) return "@appendable ";
  return extensibility == Extensibility::Mutable ? "@mutable " : "@final ";
}

}  // namespace

std::string_view primitive_name(Kind kind) {
  return kPrimitives.at(static_cast<std::size_t>(kind));
}

std::string in_words(Kind primitive) {
  return with_article(std::string(primitive_name(primitive)));
}

std::string in_words(const Type& type) { return with_article(spelled(type)); }

std::string in_words(const Declaration& declaration) {
  return with_article(annotation_of(declaration.extensibility) +
                      std::string(keyword_of(declaration.kind)) + " " + declaration.name);
}

}  // namespace skein::idl
