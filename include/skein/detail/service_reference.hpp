#pragma once

#include <iosfwd>
#include <string>

#include "skein/detail/operation.hpp"
#include "skein/guid.hpp"

namespace skein {

namespace idl {
class CdrReader;
class CdrWriter;
class JsonReader;
class JsonWriter;
}  // namespace idl

/// A service as a value that can be passed on: its interface, its provider and its instance. Sent
/// as `struct { string interface_name; octet provider[16]; string instance; }`.
struct ServiceReference {
  std::string interface_name{};
  Guid provider{};
  std::string instance{};

  friend bool operator==(const ServiceReference&, const ServiceReference&) = default;
  /// Whether it refers to no service.
  bool is_nil() const noexcept { return provider.is_nil(); }
};

/// A reference to a service of interface `I`; IDL parameters and members of an interface's type
/// become this. `I` may be incomplete. Whether the provider really offers `I` is checked on
/// connecting.
template <class I>
struct Reference : ServiceReference {
  using Interface = I;
  Reference() = default;
  explicit Reference(ServiceReference reference) : ServiceReference(std::move(reference)) {}
};

std::ostream& operator<<(std::ostream& stream, const ServiceReference& reference);
std::string to_string(const ServiceReference& reference);
const TypeSupport& type_support(const ServiceReference*);
void skein_encode(idl::CdrWriter& writer, const ServiceReference& reference);
void skein_decode(idl::CdrReader& reader, ServiceReference& reference);
void skein_write_json(idl::JsonWriter& writer, const ServiceReference& reference);
/// null and empty text refer to no service.
void skein_read_json(const idl::JsonReader& reader, ServiceReference& reference);

}  // namespace skein
