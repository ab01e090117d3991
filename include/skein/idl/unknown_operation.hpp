#pragma once

#include "skein/core/operation.hpp"

namespace skein::idl {

/// Throws Unimplemented, with a suggestion where a name is near. Used by skeletons.
[[noreturn]] void throw_unknown_operation(const InterfaceInfo& interface,
                                          const OperationInfo& operation);

}  // namespace skein::idl
