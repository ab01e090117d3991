#pragma once

#include "skein/error.hpp"

namespace skein::idl {

/// Bytes that are no value of the expected type. The text names type, member and offset. An
/// InvalidArgument: the same bytes will fail again.
class MalformedSample : public InvalidArgument {
 public:
  using InvalidArgument::InvalidArgument;
};

}  // namespace skein::idl
