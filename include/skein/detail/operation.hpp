#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <span>
#include <string>
#include <string_view>

#include "skein/detail/bytes.hpp"
#include "skein/detail/representation.hpp"

namespace skein {

struct TypeSupport;

/// A member of an @appendable or @mutable type. Two versions of the type understand each other if
/// members that both know have the same digest, and those that only one knows are not required.
struct GrowingMember {
  std::uint32_t type = 0;  ///< DDS-RPC's hash of the type's scoped name.
  /// Its place in an @appendable struct, its identifier in a @mutable one; a hash of its label in a
  /// union.
  std::uint32_t member = 0;
  std::uint32_t digest = 0;    ///< Changes with its name and type.
  bool required = false;       ///< A reader that does not know it refuses the value.
  std::string_view name = {};  ///< `A::Problem.goal`; empty where another peer tells of it.
};

/// What a type says of itself, for those who do not know it: see skein/describe.hpp.
struct TypeDescription {
  /// A types::Declaration, in CDR; nothing for the structs of an operation's parameters.
  std::string_view declaration;
  std::span<const TypeSupport& (*const)()> uses{};  ///< The types that it names.
  /// Changes with the type, but for members of types that may grow.
  std::uint64_t signature = 0;
  std::span<const GrowingMember> growing{};  ///< Its own members, if it may grow.
};

/// How to make, copy, write and read a C++ type without its definition. Generated code provides one
/// for each IDL type that is sent.
struct TypeSupport {
  std::string_view name;  ///< Scoped IDL name, `AE_navigator::Problem`.
  Representation representation = Representation::Xcdr1;
  /// A new value of the type; see make().
  void* (*create)(const TypeSupport& type);
  void (*destroy)(void* value) noexcept;
  void (*assign)(void* to, const void* from);
  /// Appends the value, little-endian, to `message`, whose first 4 bytes are the encapsulation
  /// header of its representation; alignment counts from byte 4. Throws InvalidArgument for a value
  /// that CDR cannot carry.
  void (*encode)(const void* value, Bytes& message);
  /// Reads the value at `offset` of `message`, whose header says how it is encoded, and returns the
  /// offset of its end. Throws idl::MalformedSample if the bytes are no such value.
  std::size_t (*decode)(void* value, std::span<const std::byte> message, std::size_t offset);
  std::string (*to_json)(const void* value);
  /// Throws InvalidArgument with the place in the text.
  void (*from_json)(void* value, std::string_view json);
  TypeDescription description{};

  /// A new value, to be given to destroy().
  void* make() const { return create(*this); }
};

/// An exception that IDL declares.
struct ExceptionInfo {
  std::string_view name;  ///< Scoped IDL name.
  std::uint32_t hash;     ///< Its discriminator in the result union (DDS-RPC basic mapping).
  const TypeSupport* type;
  void (*raise)(const void* value);  ///< Throws it.
};

/// Base of all exceptions that IDL declares.
class UserException : public std::exception {
 public:
  virtual const ExceptionInfo& info() const noexcept = 0;
  /// The exception object, of the type that info() describes.
  virtual const void* value() const noexcept = 0;
  const char* what() const noexcept override { return info().name.data(); }
};

/// One operation of an interface. Attributes are operations named `_get_x` and `_set_x`.
struct OperationInfo {
  std::string_view name;
  std::uint32_t hash;  ///< Discriminator in call and return unions: DDS-RPC's hash of the name.
  /// Changes if any parameter, result or exception type changes, but for members of types that may
  /// grow (InterfaceInfo::growing).
  std::uint64_t signature;
  bool oneway;            ///< No reply; success only means that the request was sent.
  bool idempotent;        ///< Declared by `@idempotent`: may be executed twice.
  bool stream;            ///< Declared by `@stream`: returns any number of out structs.
  const TypeSupport* in;  ///< The struct of in and inout parameters (`IPlanner_plan_In`).
  const TypeSupport*
      out;  ///< The struct of result, out and inout parameters (`IPlanner_plan_Out`).
  std::span<const ExceptionInfo* const> raises;
  std::string_view documentation;  ///< The comment in the IDL.
  /// Declared by `@optional`: a client connects to a provider that lacks it, too; where it is
  /// called there, the call ends as Unimplemented.
  bool optional = false;

  /// Whether it carries a type that travels as XCDR2.
  bool uses_xcdr2() const noexcept {
    bool found = is_xcdr2(in->representation) || is_xcdr2(out->representation);
    for (const ExceptionInfo* exception : raises)
      found |= is_xcdr2(exception->type->representation);
    return found;
  }
};

/// One IDL interface.
struct InterfaceInfo {
  std::string_view name;                        ///< Canonical: `AE_navigator/IPlanner`.
  std::span<const InterfaceInfo* const> bases;  ///< Direct and indirect, nearest first.
  std::span<const OperationInfo> operations;    ///< Own and inherited.
  std::string_view documentation;
  /// The members of all types that may grow and that an operation carries, by type and member.
  std::span<const GrowingMember> growing{};
  std::string_view description{};  ///< A types::Interface, in CDR.

  /// The operation with that hash, or nullptr.
  const OperationInfo* find_operation(std::uint32_t hash) const noexcept {
    for (const OperationInfo& operation : operations) {
      if (operation.hash == hash) return &operation;
    }
    return nullptr;
  }

  /// How its requests and replies travel: as XCDR2 if any of them carries a type that does.
  Representation representation() const noexcept {
    for (const OperationInfo& operation : operations) {
      if (operation.uses_xcdr2()) return Representation::Xcdr2Plain;
    }
    return Representation::Xcdr1;
  }
};

/// An implementation as the transports see it. Generated skeletons implement this class.
class Servant {
 public:
  virtual ~Servant() = default;
  virtual const InterfaceInfo& interface_info() const noexcept = 0;
  /// Runs `operation` on `in` (its in struct) and fills `out` (its out struct; for a stream, the
  /// StreamWriter that takes its out structs; for what is answered later, the PendingReply). Throws
  /// what the implementation throws. The executor decides whether several threads may be inside at
  /// once.
  virtual void dispatch(const OperationInfo& operation, const void* in, void* out) = 0;
  /// Whether its operations take a PendingReply, but for streams and those that are oneway.
  virtual bool answers_later() const noexcept { return false; }
};

}  // namespace skein
