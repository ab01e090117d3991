#pragma once

#include <exception>
#include <memory>
#include <span>
#include <string>

#include "rpc/wire/wire.hpp"
#include "skein/detail/operation.hpp"

namespace skein::rpc {

/// One reply, understood. Its out struct is filled where `error` is null and `part` is not End.
struct Reply {
  std::exception_ptr error;
  wire::StreamPart part = wire::StreamPart::None;
  std::uint64_t position = 0;
};

/// Fills `out`, or tells what the operation ended with; throws where the bytes are neither. `peer`
/// is for messages.
Reply read_reply(const OperationInfo& operation, void* out, std::span<const std::byte> message,
                 const wire::ReplyHead& head, const std::string& peer);

/// The Error of a reply that is no result.
std::exception_ptr error_in(std::span<const std::byte> message, const wire::ReplyHead& head,
                            std::string_view operation, const std::string& peer);

}  // namespace skein::rpc
