#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <span>
#include <string>
#include <string_view>

#include "skein/core/bytes.hpp"

namespace skein {

/// What the library must know of one C++ type to carry it without its definition: how to make,
/// copy, write and read it. Generated code provides one for each IDL type that travels.
struct TypeSupport {
  std::string_view name;  ///< Scoped IDL name, `AE_navigator::Problem`.
  void* (*make)();
  void (*destroy)(void* value) noexcept;
  void (*assign)(void* to, const void* from);
  /// Appends PLAIN_CDR little-endian to `message`, whose first 4 bytes are the encapsulation
  /// header; alignment counts from byte 4.
  void (*encode)(const void* value, Bytes& message);
  /// Reads the value that starts at `offset` of `message` and returns where it ends.
  /// Throws idl::MalformedSample where the bytes do not hold such a value.
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
  [[noreturn]] void (*raise)(const void* value);
};

/// The base of all exceptions that IDL declares.
class UserException : public std::exception {
 public:
  virtual const ExceptionInfo& info() const noexcept = 0;
  /// The object of the type that info() describes.
  virtual const void* value() const noexcept = 0;
  const char* what() const noexcept override { return info().name.data(); }
};

/// One operation of an interface. Attributes are operations named `_get_x` and `_set_x`.
struct OperationInfo {
  std::string_view name;
  std::uint32_t hash;  ///< Discriminator of call and return unions: DDS-RPC's hash of the name.
  std::uint64_t signature;  ///< Changes when any parameter, result or exception type changes.
  bool oneway;              ///< No reply; a success says only that the request was handed over.
  bool idempotent;          ///< Declared by `#pragma idempotent`: may be executed twice.
  bool stream;              ///< Declared by `#pragma stream`: brings any number of out structs.
  const TypeSupport* in;    ///< The struct of in and inout parameters (`plan_In`).
  const TypeSupport* out;   ///< The struct of result, out and inout parameters (`plan_Out`).
  std::span<const ExceptionInfo* const> raises;
  std::string_view documentation;  ///< The IDL's own comment.
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

/// What an implementation looks like to those who carry calls to it. Generated skeletons implement
/// it.
class Servant {
 public:
  virtual ~Servant() = default;
  virtual const InterfaceInfo& interface_info() const noexcept = 0;
  /// Runs `operation` on `in` (its in struct) and fills `out` (its out struct; for a stream, the
  /// StreamWriter that takes its out structs). Throws what the implementation throws. Whether
  /// several threads may be inside at once is the executor's affair.
  virtual void dispatch(const OperationInfo& operation, const void* in, void* out) = 0;
};

}  // namespace skein
