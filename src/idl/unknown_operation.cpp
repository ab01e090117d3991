#include "skein/detail/unknown_operation.hpp"

#include <string>
#include <vector>

#include "core/suggestion.hpp"
#include "skein/error.hpp"

namespace skein::idl {

void throw_unknown_operation(const InterfaceInfo& interface, const OperationInfo& operation) {
  std::vector<std::string> known;
  for (const OperationInfo& one : interface.operations) known.emplace_back(one.name);
  throw Unimplemented(std::string(interface.name) + " has no operation '" +
                      std::string(operation.name) + "'" + suggestion(operation.name, known));
}

void throw_no_implementation(const InterfaceInfo& interface) {
  throw InvalidArgument("a service of " + std::string(interface.name) +
                        " has no implementation: null");
}

}  // namespace skein::idl
