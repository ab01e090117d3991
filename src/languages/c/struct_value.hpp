#pragma once

#include <cstddef>
#include <memory>
#include <memory_resource>

#include "idl/types/dynamic_type.hpp"
#include "skein/detail/bytes.hpp"

/// Values as C structs, laid out as the IDL compiler declares them and as the C compiler lays them
/// out: members in their order, each aligned as its type requires.
///
/// | IDL | C |
/// |---|---|
/// | boolean, numbers, char, octet | bool, float, double, intN_t, uintN_t, char, uint8_t |
/// | wchar | uint16_t: a unit of UTF-16 |
/// | string, wstring | const char*, UTF-8; NULL is empty |
/// | sequence, map | struct {const T* data; size_t size;}, of a map's pairs {key, value} |
/// | array | T[n] |
/// | an optional or @external member | const T*; NULL if it is absent |
/// | enumeration; bitmask, bitset | intN_t; uintN_t, of as many bits as on the wire |
/// | union | struct {discriminator d; union {...} u;} |
/// | an interface's reference | skein_reference |
namespace skein::c {

/// Of a struct's type. Throws InvalidArgument for types that contain themselves too deeply.
std::size_t struct_size(const idl::DynamicType& type);

/// The CDR of a struct. Throws InvalidArgument for what CDR cannot carry, and for a size that is
/// not the struct's: it was compiled from another IDL.
Bytes cdr_of_struct(const idl::DynamicType& type, const void* value, std::size_t size);

/// A struct, and the memory that it points to.
class StructValue {
 public:
  /// Of a message with its encapsulation header. Throws MalformedSample.
  StructValue(const idl::DynamicType& type, std::span<const std::byte> cdr);

  const void* data() const noexcept { return data_; }
  std::size_t size() const noexcept { return size_; }

 private:
  std::unique_ptr<std::pmr::monotonic_buffer_resource> memory_;
  std::size_t size_;
  void* data_;
};

}  // namespace skein::c
