#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <span>
#include <string>
#include <string_view>

#include "skein/detail/bytes.hpp"

namespace skein {

/// How to make, copy, write and read a C++ type without its definition. Generated code provides one
/// for each IDL type that is sent.
struct TypeSupport {
  std::string_view name;  ///< Scoped IDL name, `AE_navigator::Problem`.
  void* (*make)();
  void (*destroy)(void* value) noexcept;
  void (*assign)(void* to, const void* from);
  /// Appends PLAIN_CDR, little-endian, to `message`, whose first 4 bytes are the encapsulation
  /// header; alignment counts from byte 4. Throws InvalidArgument for a value that CDR cannot
  /// carry.
  void (*encode)(const void* value, Bytes& message);
  /// Reads the value at `offset` of `message` and returns the offset of its end. Throws
  /// idl::MalformedSample if the bytes are no such value.
  std::size_t (*decode)(void* value, std::span<const std::byte> message, std::size_t offset);
  std::string (*to_json)(const void* value);
  /// Throws InvalidArgument with the place in the text.
  void (*from_json)(void* value, std::string_view json);
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
  std::uint64_t signature;  ///< Changes if any parameter, result or exception type changes.
  bool oneway;              ///< No reply; success only means that the request was sent.
  bool idempotent;          ///< Declared by `#pragma idempotent`: may be executed twice.
  bool stream;              ///< Declared by `#pragma stream`: returns any number of out structs.
  const TypeSupport* in;    ///< The struct of in and inout parameters (`IPlanner_plan_In`).
  const TypeSupport*
      out;  ///< The struct of result, out and inout parameters (`IPlanner_plan_Out`).
  std::span<const ExceptionInfo* const> raises;
  std::string_view documentation;  ///< The comment in the IDL.
};

/// One IDL interface.
struct InterfaceInfo {
  std::string_view name;                        ///< Canonical: `AE_navigator/IPlanner`.
  std::span<const InterfaceInfo* const> bases;  ///< Direct and indirect, nearest first.
  std::span<const OperationInfo> operations;    ///< Own and inherited.
  std::string_view documentation;

  /// The operation with that hash, or nullptr.
  const OperationInfo* find_operation(std::uint32_t hash) const noexcept {
    for (const OperationInfo& operation : operations) {
      if (operation.hash == hash) return &operation;
    }
    return nullptr;
  }
};

/// An implementation as the transports see it. Generated skeletons implement this class.
class Servant {
 public:
  virtual ~Servant() = default;
  virtual const InterfaceInfo& interface_info() const noexcept = 0;
  /// Runs `operation` on `in` (its in struct) and fills `out` (its out struct; for a stream, the
  /// StreamWriter that takes its out structs). Throws what the implementation throws. The executor
  /// decides whether several threads may be inside at once.
  virtual void dispatch(const OperationInfo& operation, const void* in, void* out) = 0;
};

}  // namespace skein
