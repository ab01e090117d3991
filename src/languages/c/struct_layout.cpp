#include "struct_layout.hpp"

#include "skein/c/skein.h"
#include "skein/detail/cdr.hpp"
#include "skein/error.hpp"

namespace skein::c {
namespace {

using idl::DynamicType;
using types::DeclarationKind;
using types::Kind;

/// Counts the nesting of types: those that a peer described may contain themselves.
class Deeper {
 public:
  explicit Deeper(const DynamicType& type) {
    if (depth_ >= idl::kMaximumNesting) {
      throw InvalidArgument(type.declaration->name + " is nested too deeply, or contains itself");
    }
    ++depth_;
  }
  ~Deeper() { --depth_; }
  Deeper(const Deeper&) = delete;
  Deeper& operator=(const Deeper&) = delete;

 private:
  static thread_local unsigned depth_;
};
thread_local unsigned Deeper::depth_ = 0;

Layout layout_of_members(const DynamicType& type) {
  if (type.members.empty()) return layout_of<char>();
  Layout layout;
  for (const DynamicType::Member& member : type.members) layout.add(layout_of(member));
  return layout.padded();
}

Layout layout_of_declared(const DynamicType& type) {
  const Deeper deeper(type);
  if (type.declaration->kind >= DeclarationKind::Enumeration) {
    return idl::with_integer(type.declaration->bits,
                             [](auto zero) { return layout_of<decltype(zero)>(); });
  }
  if (!type.is(DeclarationKind::Union)) return layout_of_members(type);
  Layout whole;
  union_layout(type, whole);
  return whole;
}

}  // namespace

bool is_plain(Kind kind) { return kind < Kind::LongDouble && kind != Kind::WideChar; }

bool is_pointed_to(const DynamicType::Member& member) {
  return member.type->kind != Kind::OptionalMember &&
         idl::has(member.described->flags, types::MemberFlags::in_own_memory);
}

Layout layout_of(const DynamicType::Member& member) {
  return is_pointed_to(member) ? layout_of<const void*>() : layout_of(*member.type);
}

std::size_t union_layout(const DynamicType& type, Layout& whole) {
  Layout members;
  for (const DynamicType::Member& member : type.members) {
    const Layout each = layout_of(member);
    members = {std::max(members.size, each.size), std::max(members.alignment, each.alignment)};
  }
  whole = layout_of(*type.discriminator);
  const std::size_t at = whole.add(members.padded());
  whole = whole.padded();
  return at;
}

Layout layout_of(const DynamicType& type) {
  switch (type.kind) {
    case Kind::WideChar:
      return layout_of<std::uint16_t>();
    case Kind::LongDouble:
      return layout_of<long double>();
    case Kind::String:
    case Kind::WideString:
    case Kind::OptionalMember:
      return layout_of<const void*>();
    case Kind::Sequence:
    case Kind::Map:
      return layout_of<Sequence>();
    case Kind::Array: {
      const Layout element = layout_of(*type.elements[0]);
      return {element.size * type.bound, element.alignment};
    }
    case Kind::Reference:
      return layout_of<skein_reference>();
    case Kind::Declared:
      return layout_of_declared(type);
    default:
      return idl::with_primitive(type.kind, [](auto zero) { return layout_of<decltype(zero)>(); });
  }
}

std::size_t pair_layout(const DynamicType& map, Layout& pair) {
  pair = layout_of(*map.elements[0]);
  const std::size_t at = pair.add(layout_of(*map.elements[1]));
  pair = pair.padded();
  return at;
}

std::int64_t number_at(const DynamicType& type, const std::byte* from) {
  if (type.kind == Kind::WideChar) return load<std::uint16_t>(from);
  const auto read = [&](auto zero) -> std::int64_t {
    if constexpr (std::is_same_v<decltype(zero), char>) return static_cast<unsigned char>(*from);
    return static_cast<std::int64_t>(load<decltype(zero)>(from));
  };
  if (type.kind == Kind::Declared) return idl::with_integer(type.declaration->bits, read);
  return idl::with_primitive(type.kind, read);
}

}  // namespace skein::c
