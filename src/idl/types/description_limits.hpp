#pragma once

#include "skein/types.idl.hpp"

namespace skein::idl {

/// For what a peer has told: who walks through types goes from one to the next, as deep as they are
/// many, into sequences of sequences, and to the outermost module of a name. Throws InvalidArgument
/// where there are more than 1024 types and interfaces, one stands within more than 16 sequences,
/// arrays, maps and optional members, or a name has more than 32 parts.
void check_limits(const types::TypeSystem& described);

}  // namespace skein::idl
