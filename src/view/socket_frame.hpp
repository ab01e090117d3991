#pragma once

#include <cstddef>
#include <memory>
#include <string>

namespace skein::view {

/// One WebSocket message to a client: `head`, then `body`, which several clients may share.
struct Frame {
  bool text = false;  ///< Otherwise it is binary.
  std::string head;
  std::shared_ptr<const std::string> body;

  std::size_t size() const { return head.size() + (body ? body->size() : 0); }
};

}  // namespace skein::view
