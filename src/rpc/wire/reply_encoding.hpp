#pragma once

#include <exception>
#include <string>

#include "rpc/wire/wire.hpp"
#include "skein/detail/operation.hpp"

namespace skein::rpc {

/// The reply of a call that ended with an Error.
void encode_error(Bytes& message, Representation representation, const wire::RequestId& id,
                  ErrorCode code, const std::string& text, std::uint32_t operation = 0);

/// The reply of a call: its out struct, or the Error or declared exception that was thrown;
/// Internal where CDR cannot carry it.
void encode_outcome(Bytes& message, Representation representation, const wire::RequestId& id,
                    const OperationInfo& operation, const void* out,
                    const std::exception_ptr& error);

/// A result of a stream, with more to follow, and the reply that ends it after `position` results.
/// Throws Internal where CDR cannot carry the result.
void encode_item(Bytes& message, Representation representation, const wire::RequestId& id,
                 const OperationInfo& operation, const void* out, std::uint64_t position);
void encode_end(Bytes& message, Representation representation, const wire::RequestId& id,
                const OperationInfo& operation, std::uint64_t position);

}  // namespace skein::rpc
