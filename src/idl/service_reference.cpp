#include "skein/detail/service_reference.hpp"

#include <ostream>

#include "skein/detail/make_type_support.hpp"

namespace skein {

std::ostream& operator<<(std::ostream& stream, const ServiceReference& reference) {
  return stream << to_string(reference);
}

std::string to_string(const ServiceReference& reference) { return idl::text_of(reference); }

const TypeSupport& type_support(const ServiceReference*) {
  static constexpr TypeSupport support =
      idl::make_type_support<ServiceReference>("skein::ServiceReference", {});
  return support;
}

void skein_encode(idl::CdrWriter& writer, const ServiceReference& reference) {
  idl::encode(writer, reference.interface_name);
  idl::encode(writer, reference.provider.bytes);
  idl::encode(writer, reference.instance);
}

void skein_decode(idl::CdrReader& reader, ServiceReference& reference) {
  reader.at("ServiceReference.interface_name");
  idl::decode(reader, reference.interface_name);
  reader.at("ServiceReference.provider");
  idl::decode(reader, reference.provider.bytes);
  reader.at("ServiceReference.instance");
  idl::decode(reader, reference.instance);
}

void skein_write_json(idl::JsonWriter& writer, const ServiceReference& reference) {
  writer.begin_object("ServiceReference");
  writer.key("interface_name");
  writer.write_string(reference.interface_name);
  writer.key("provider");
  writer.write_name(reference.provider.hex());
  writer.key("instance");
  writer.write_string(reference.instance);
  writer.end_object();
}

void skein_read_json(const idl::JsonReader& reader, ServiceReference& reference) {
  static constexpr std::string_view members[] = {"interface_name", "provider", "instance"};
  if (reader.is_null() || reader.is_empty_string()) {
    reference = {};
    return;
  }
  reader.expect_members("ServiceReference", members);
  reference.interface_name = reader.member("interface_name").read_string();
  const auto provider = Guid::from_hex(reader.member("provider").read_string());
  if (!provider) reader.member("provider").fail("is no identity of 32 hexadecimal digits");
  reference.provider = *provider;
  reference.instance = reader.member("instance").read_string();
}

}  // namespace skein
