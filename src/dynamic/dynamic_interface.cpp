#include "dynamic_interface.hpp"

#include <algorithm>
#include <cstring>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <set>

#include "core/suggestion.hpp"
#include "core/system/interface_name.hpp"
#include "idl/types/parameter_struct.hpp"
#include "skein/detail/codec.hpp"
#include "skein/detail/key_hash.hpp"
#include "skein/dynamic.hpp"
#include "skein/error.hpp"

namespace skein {
namespace {

using idl::has;
using types::OperationFlags;

/// DDS-RPC, basic mapping: the first four bytes of the name's MD5, little-endian.
std::uint32_t name_hash(const std::string& name) {
  const Guid digest = idl::md5(std::as_bytes(std::span(name)));
  std::uint32_t hash = 0;
  for (std::size_t i = 0; i < 4; ++i) hash |= std::uint32_t{digest.bytes[i]} << (8 * i);
  return hash;
}

[[noreturn]] void raise(const void* value) {
  const auto& thrown = *static_cast<const idl::DynamicValue*>(value);
  const auto& support = static_cast<const DynamicExceptionSupport&>(*thrown.support);
  auto kept = std::make_shared<idl::DynamicValue>(thrown);
  idl::own(*kept);
  throw DynamicException(support.info, kept, idl::json_of(thrown));
}

/// An interface with its bases, by name, each once; those that are not described are left out.
void for_each_interface(const types::TypeSystem& types, const std::string& name,
                        std::set<std::string>& seen,
                        const std::function<void(const types::Interface&)>& visit) {
  const auto found = std::ranges::find(types.interfaces, name, &types::Interface::name);
  if (found == types.interfaces.end() || !seen.insert(name).second) return;
  visit(*found);
  for (const std::string& base : found->bases) for_each_interface(types, base, seen, visit);
}

}  // namespace

DynamicExceptionSupport::DynamicExceptionSupport(const idl::DynamicType& described,
                                                 idl::DynamicForm held)
    : DynamicSupport(described, held), info{name, name_hash(std::string(name)), this, raise} {}

DynamicInterface::DynamicInterface(const discovery::ServiceDescription& service,
                                   types::TypeSystem known, idl::DynamicForm form)
    : name_(canonical_interface_name(service.service)), form_(form), types_(std::move(known)) {
  std::set<std::string> seen;
  const auto& described = types_.described();
  for_each_interface(described, scoped_interface_name(name_), seen,
                     [&](const types::Interface& each) { add_operations(each, service); });
  if (seen.empty()) {
    throw InvalidArgument("the provider of " + name_ + " did not describe that interface");
  }
  for (const discovery::GrowingMember& each : service.growing) {
    growing_.push_back({each.type, each.member, each.digest, each.required});
  }
  info_.name = name_;
  info_.operations = operations_;
  info_.growing = growing_;
  info_.description = description_of(name_);
  add_bases(service);
}

void DynamicInterface::add_bases(const discovery::ServiceDescription& service) {
  for (const std::string& name : service.bases) {
    Base& base = bases_.emplace_back(Base{canonical_interface_name(name)});
    base.info.name = base.name;
    base.info.description = description_of(base.name);
    base_infos_.push_back(&base.info);
  }
  info_.bases = base_infos_;
}

std::string_view DynamicInterface::description_of(const std::string& canonical) {
  const auto& all = types_.described().interfaces;
  const auto found =
      std::ranges::find(all, scoped_interface_name(canonical), &types::Interface::name);
  if (found == all.end()) return {};
  const Bytes& cdr = descriptions_.emplace_back(idl::encode_message(*found));
  return {reinterpret_cast<const char*>(cdr.data()), cdr.size()};
}

void DynamicInterface::add_operations(const types::Interface& interface,
                                      const discovery::ServiceDescription& service) {
  for (const types::Operation& operation : interface.operations) {
    const auto digest =
        std::ranges::find(service.operations, operation.name, &discovery::OperationDigest::name);
    if (digest != service.operations.end()) add_operation(interface, operation, *digest);
  }
}

void DynamicInterface::add_operation(const types::Interface& interface,
                                     const types::Operation& described,
                                     const discovery::OperationDigest& digest) {
  const std::string place = scoped_interface_name(name_) + "::" + described.name;
  auto& in = supports_.emplace_back(
      types_.add_struct(place, idl::in_struct(interface, described).members), form_);
  auto& out = supports_.emplace_back(
      types_.add_struct(place + " (result)", idl::out_struct(interface, described).members), form_);
  auto& raised = raises_.emplace_back();
  for (const std::string& name : described.raises) raised.push_back(exception(name));
  operations_.push_back({described.name, digest.hash, digest.signature,
                         has(described.flags, OperationFlags::one_way),
                         has(described.flags, OperationFlags::idempotent),
                         has(described.flags, OperationFlags::stream), &in, &out, raised,
                         std::string_view(), has(described.flags, OperationFlags::optional)});
  described_.push_back(&described);
}

const ExceptionInfo* DynamicInterface::exception(const std::string& name) {
  for (const DynamicExceptionSupport& known : exceptions_) {
    if (known.name == name) return &known.info;
  }
  const idl::DynamicType& type = types_.type(name);
  if (!type.is(types::DeclarationKind::Exception)) {
    throw InvalidArgument("'" + name + "' is raised, but described as no exception");
  }
  return &exceptions_.emplace_back(type, form_).info;
}

const ExceptionInfo& DynamicInterface::raised(const std::string& name) const {
  std::vector<std::string> known;
  for (const DynamicExceptionSupport& each : exceptions_) {
    if (each.name == name) return each.info;
    known.emplace_back(each.name);
  }
  throw InvalidArgument(scoped_interface_name(name_) + " raises no exception '" + name + "'" +
                        suggestion(name, known));
}

std::vector<std::string> DynamicInterface::names() const {
  std::vector<std::string> names;
  for (const OperationInfo& operation : operations_) names.emplace_back(operation.name);
  return names;
}

const OperationInfo& DynamicInterface::operation(const std::string& name) const {
  const auto found = std::ranges::find(operations_, name, &OperationInfo::name);
  if (found != operations_.end()) return *found;
  std::string list;
  for (const std::string& each : names()) list += (list.empty() ? "" : ", ") + each;
  throw InvalidArgument(scoped_interface_name(name_) + " has no operation '" + name + "'" +
                        suggestion(name, names()) + "; it has " + (list.empty() ? "none" : list));
}

const types::Operation& DynamicInterface::described(const std::string& name) const {
  return *described_[static_cast<std::size_t>(&operation(name) - operations_.data())];
}

const DynamicInterface& dynamic_interface(const discovery::ServiceDescription& service,
                                          types::TypeSystem known, idl::DynamicForm form) {
  static std::mutex mutex;
  // Never destroyed: connections may outlive main().
  static auto& interfaces = *new std::map<std::string, std::unique_ptr<DynamicInterface>>;
  discovery::ServiceDescription version;
  version.service = service.service;
  version.operations = service.operations;
  version.growing = service.growing;
  version.bases = service.bases;
  const Bytes told = idl::encode_message(version);
  const Bytes types = idl::encode_message(known);
  std::string key(1, static_cast<char>(form));
  key.append(reinterpret_cast<const char*>(told.data()), told.size());
  key.append(reinterpret_cast<const char*>(types.data()), types.size());
  std::lock_guard lock(mutex);
  auto& interface = interfaces[key];
  if (!interface) interface = std::make_unique<DynamicInterface>(service, std::move(known), form);
  return *interface;
}

}  // namespace skein
