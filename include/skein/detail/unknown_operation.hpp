#pragma once

#include "skein/detail/operation.hpp"

namespace skein::idl {

/// Throws Unimplemented, with the nearest name if there is one. Used by skeletons.
[[noreturn]] void throw_unknown_operation(const InterfaceInfo& interface,
                                          const OperationInfo& operation);

/// Throws InvalidArgument: a skeleton is made of a null pointer. Used by skeletons.
[[noreturn]] void throw_no_implementation(const InterfaceInfo& interface);

}  // namespace skein::idl
