#pragma once

#include <string>

#include "skein/detail/operation.hpp"
#include "skein/discovery.idl.hpp"

namespace skein::types {
struct TypeSystem;
}

namespace skein::brokerless_discovery {

/// Whether a client of this interface can call `provider`: it has all of the client's operations
/// but for those that are `@optional`, with their signatures, and the types that may grow have only
/// grown. `provider.growing` is sorted.
bool understands(const InterfaceInfo& client, const discovery::ServiceDescription& provider);
/// The same of a provider whose interface is at hand.
bool understands(const InterfaceInfo& client, const InterfaceInfo& provider);

/// Whether it has those of the client's operations, too, that a provider may lack.
bool has_all_operations(const InterfaceInfo& client, const discovery::ServiceDescription& provider);

/// What of the provider's interface is another, for people; empty where understands() holds.
std::string difference(const InterfaceInfo& client, const discovery::ServiceDescription& provider);

/// The same with the place within the operation, if `told`, which the provider says of its own
/// types, has it.
std::string difference(const InterfaceInfo& client, const discovery::ServiceDescription& provider,
                       const types::TypeSystem& told);

/// Puts the members in the order of InterfaceInfo::growing.
void sort_growing(discovery::ServiceDescription& description);

}  // namespace skein::brokerless_discovery
