#include <algorithm>

#include "dynamic_support.hpp"
#include "skein/describe.hpp"
#include "skein/detail/codec.hpp"

namespace skein {
namespace {

template <class T>
T read(std::string_view cdr) {
  return idl::decode_message<T>(std::as_bytes(std::span(cdr)));
}

bool is_known(const auto& declared, const std::string& name) {
  return std::ranges::any_of(declared, [&](const auto& one) { return one.name == name; });
}

void add(const types::TypeSystem& described, types::TypeSystem& known) {
  for (const types::Declaration& each : described.declarations) {
    if (!is_known(known.declarations, each.name)) known.declarations.push_back(each);
  }
  for (const types::Interface& each : described.interfaces) {
    if (!is_known(known.interfaces, each.name)) known.interfaces.push_back(each);
  }
}

void add(const TypeSupport& type, types::TypeSystem& known) {
  if (const auto* dynamic = idl::DynamicSupport::of(type)) return add(*dynamic->type.system, known);
  if (!type.description.declaration.empty()) {
    if (is_known(known.declarations, std::string(type.name))) return;
    known.declarations.push_back(read<types::Declaration>(type.description.declaration));
  }
  for (const auto used : type.description.uses) add(used(), known);
}

void add(const InterfaceInfo& interface, types::TypeSystem& known) {
  if (interface.description.empty()) return;  // a base of which nothing was told
  auto description = read<types::Interface>(interface.description);
  if (is_known(known.interfaces, description.name)) return;
  known.interfaces.push_back(std::move(description));
  for (const InterfaceInfo* base : interface.bases) add(*base, known);
  for (const OperationInfo& operation : interface.operations) {
    add(*operation.in, known);
    add(*operation.out, known);
    for (const ExceptionInfo* exception : operation.raises) add(*exception->type, known);
  }
}

}  // namespace

types::TypeSystem describe(const TypeSupport& type, types::TypeSystem known) {
  add(type, known);
  return known;
}

types::TypeSystem describe(const InterfaceInfo& interface, types::TypeSystem known) {
  add(interface, known);
  return known;
}

}  // namespace skein
