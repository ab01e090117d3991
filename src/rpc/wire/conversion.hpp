#pragma once

#include <exception>

#include "skein/detail/operation.hpp"

/// Between two C++ types of one IDL type: a process may hold two versions of a type that may grow.
namespace skein::rpc {

/// Sets `to` to what `from` is: by assignment where both are of one C++ type, else by CDR. Throws
/// InvalidArgument or MalformedSample where that is not possible.
void convert(const TypeSupport& from_type, const void* from, const TypeSupport& to_type, void* to);

/// The error as `operation` declares it: a declared exception becomes that of its own code.
std::exception_ptr convert(const std::exception_ptr& error, const OperationInfo& operation);

}  // namespace skein::rpc
