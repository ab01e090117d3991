#pragma once

#include <memory>

#include "skein/call_context.hpp"
#include "skein/selection.hpp"

namespace skein::entity {

/// What a connected client has asked the Head for.
struct HeadSession final : Session {
  explicit HeadSession(std::shared_ptr<const SelectionStrategy> asked)
      : strategy(std::move(asked)) {}
  const std::shared_ptr<const SelectionStrategy> strategy;
};

}  // namespace skein::entity
