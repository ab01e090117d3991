#pragma once

#include <string>

#include "skein/types.idl.hpp"

namespace skein::idl {

/// The in struct of an operation, or its out struct, as generated code has them:
/// `A::I_operation_In`.
types::Declaration in_struct(const types::Interface& interface, const types::Operation& operation);
types::Declaration out_struct(const types::Interface& interface, const types::Operation& operation);

}  // namespace skein::idl
