#include "brokerless_discovery/versions.hpp"

#include <algorithm>
#include <tuple>

#include "core/growth.hpp"
#include "core/system/interface_name.hpp"
#include "idl/types/type_difference.hpp"
#include "skein/describe.hpp"

namespace skein::brokerless_discovery {
namespace {

using discovery::OperationDigest;
using discovery::ServiceDescription;

const OperationDigest* find_operation(const ServiceDescription& provider, std::uint32_t hash) {
  const auto found = std::ranges::find(provider.operations, hash, &OperationDigest::hash);
  return found == provider.operations.end() ? nullptr : &*found;
}

const OperationInfo* find_operation(const InterfaceInfo& provider, std::uint32_t hash) {
  return provider.find_operation(hash);
}

/// `provider` is its description, or its interface.
template <class Provider>
const OperationInfo* differing_operation(const InterfaceInfo& client, const Provider& provider) {
  for (const OperationInfo& operation : client.operations) {
    const auto* const there = find_operation(provider, operation.hash);
    if (there ? there->signature != operation.signature : !operation.optional) return &operation;
  }
  return nullptr;
}

template <class Provider>
auto differing_member(const InterfaceInfo& client, const Provider& provider) {
  return find_difference(client.growing, provider.growing);
}

std::string text(const GrowingMember* here, const discovery::GrowingMember* there,
                 const InterfaceInfo& client) {
  if (!there) {
    return "the member " + std::string(here->name) + " must be understood, and is not known there";
  }
  if (!here) {
    const auto sibling = std::ranges::find(client.growing, there->type, &GrowingMember::type);
    const std::string type(sibling->name.substr(0, sibling->name.rfind('.')));
    return "a member of " + type + " that must be understood there is not known here";
  }
  return "the member " + std::string(here->name) + " has another name or type there (" +
         hexadecimal(there->digest, 8) + ", here " + hexadecimal(here->digest, 8) + ")";
}

}  // namespace

bool understands(const InterfaceInfo& client, const ServiceDescription& provider) {
  return !differing_operation(client, provider) && !differing_member(client, provider);
}

bool understands(const InterfaceInfo& client, const InterfaceInfo& provider) {
  return !differing_operation(client, provider) && !differing_member(client, provider);
}

bool has_all_operations(const InterfaceInfo& client, const ServiceDescription& provider) {
  return std::ranges::all_of(client.operations, [&](const OperationInfo& operation) {
    return find_operation(provider, operation.hash) != nullptr;
  });
}

std::string difference(const InterfaceInfo& client, const ServiceDescription& provider) {
  if (const OperationInfo* operation = differing_operation(client, provider)) {
    const std::string name = "operation '" + std::string(operation->name) + "' ";
    const OperationDigest* digest = find_operation(provider, operation->hash);
    if (!digest) return name + "is missing there";
    return name + "has another signature there (" + hexadecimal(digest->signature, 16) + ", here " +
           hexadecimal(operation->signature, 16) + ")";
  }
  const auto member = differing_member(client, provider);
  return member ? text(member->here, member->there, client) : "";
}

std::string difference(const InterfaceInfo& client, const ServiceDescription& provider,
                       const types::TypeSystem& told) {
  std::string plain = difference(client, provider);
  if (plain.empty() || client.description.empty()) return plain;
  const auto found = idl::difference_of_interfaces(scoped_interface_name(std::string(client.name)),
                                                   describe(client), told);
  return found ? idl::in_words(*found) : plain;
}

void sort_growing(ServiceDescription& description) {
  std::ranges::sort(description.growing, {}, [](const discovery::GrowingMember& member) {
    return std::tuple(member.type, member.member);
  });
}

}  // namespace skein::brokerless_discovery
