#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "flags.hpp"
#include "skein/detail/cdr.hpp"
#include "skein/types.idl.hpp"

namespace skein::idl {

/// A type that is known by its description alone, with all that it names resolved. Made and kept by
/// DynamicTypes.
struct DynamicType {
  struct Member {
    const types::Member* described = nullptr;
    const DynamicType* type = nullptr;
    std::string place{};    ///< `A::S.x`, for messages.
    std::string initial{};  ///< What @default says, as JSON; empty without.
  };

  types::Kind kind = types::Kind::Declared;
  std::uint32_t bound = 0;                          ///< As types::Type has it.
  std::vector<const DynamicType*> elements{};       ///< Likewise.
  const types::Declaration* declaration = nullptr;  ///< Of Kind::Declared.
  const DynamicType* discriminator = nullptr;       ///< Of a union.
  std::vector<Member> members{};                    ///< Of a struct, an exception or a union.
  std::vector<std::string_view> names{};  ///< Of members, enumerators, or fields that have one.
  std::vector<Flag> flags{};              ///< Of a bitmask.
  Representation representation = Representation::Xcdr1;
  const types::TypeSystem* system = nullptr;  ///< Of Kind::Declared: which declares it.

  bool is(types::DeclarationKind wanted) const {
    return declaration != nullptr && declaration->kind == wanted;
  }
  bool is_struct() const {
    return is(types::DeclarationKind::Struct) || is(types::DeclarationKind::Exception);
  }
  /// The union's member that a discriminator selects; null if it selects none.
  const Member* selected(std::int64_t label) const;
  /// The union's member that a new value holds.
  const Member& initial_member() const;
  /// A discriminator that selects the member.
  std::int64_t label_of(const Member& member) const;
  /// Whether XCDR2 has a length in bytes before a sequence or an array of such elements.
  bool is_delimited_element() const;
  /// Whether a value of it is an object in JSON.
  bool is_object() const;
};

/// The types of a types::TypeSystem. Immutable once made; thread-safe then.
class DynamicTypes {
 public:
  /// Throws InvalidArgument if a description lacks what its kind has, or names what is not
  /// declared.
  explicit DynamicTypes(types::TypeSystem described);
  DynamicTypes(const DynamicTypes&) = delete;
  DynamicTypes& operator=(const DynamicTypes&) = delete;

  const types::TypeSystem& described() const noexcept { return described_; }

  /// A declared type. Throws InvalidArgument, with the most similar name, where there is none.
  const DynamicType& type(const std::string& name) const;

  /// A struct of these members: the arguments of an operation, say. `name` is for messages.
  const DynamicType& add_struct(const std::string& name, std::vector<types::Member> members);

 private:
  const DynamicType* resolve(const types::Type& type);
  void complete(DynamicType& type, const types::Declaration& declaration);
  void complete_members(DynamicType& type, const types::Declaration& declaration);
  void choose_representation(DynamicType& type) const;

  const types::TypeSystem described_;
  std::deque<types::Declaration> added_;
  std::deque<DynamicType> types_;
  std::map<std::string, DynamicType*, std::less<>> declared_;
};

}  // namespace skein::idl
