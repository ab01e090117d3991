#pragma once

#include <exception>

#include "skein/detail/operation.hpp"

namespace skein::rpc {

/// Runs the operation. What it throws is the same for every caller, whatever transport the call
/// came by: an Error and an exception that the operation declares as they are; as Internal what is
/// neither, and an exception that CDR cannot carry.
void call_servant(Servant& servant, const OperationInfo& operation, const void* in, void* out);

/// Throws what call_servant() throws where the operation throws `error`.
[[noreturn]] void throw_for_caller(const OperationInfo& operation, const std::exception_ptr& error);

}  // namespace skein::rpc
