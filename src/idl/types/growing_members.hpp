#pragma once

#include <vector>

#include "skein/detail/operation.hpp"

namespace skein::idl {

/// The members of all types in `type`, itself included, that may grow: by type and member, each
/// once.
std::vector<GrowingMember> growing_members(const TypeSupport& type);

}  // namespace skein::idl
