#pragma once

#include "skein/detail/operation.hpp"
#include "skein/error.hpp"

namespace skein::idl {

/// What CdrWriter throws of a text with a zero byte.
class ZeroByte : public InvalidArgument {
 public:
  ZeroByte();
};

/// As type.encode(). What it throws of a text with a zero byte names the member that holds it.
void encode_value(const TypeSupport& type, const void* value, Bytes& message);

}  // namespace skein::idl
