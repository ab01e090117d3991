#include "idl/left_out.hpp"

#include <utility>

namespace skein::idl {

thread_local LeavingOut* LeavingOut::current_ = nullptr;
thread_local PuttingIn* PuttingIn::current_ = nullptr;

bool LeavingOut::take(const void* value, std::size_t size, std::size_t position) {
  if (memory_) return false;
  auto memory = LoanMemory::find(value);
  if (!memory || memory->size() != size) return false;
  memory_ = std::move(memory);
  position_ = position;
  return true;
}

std::optional<std::span<const std::byte>> PuttingIn::take(std::size_t position) {
  if (position != position_ || std::exchange(taken_, true)) return std::nullopt;
  return value_;
}

}  // namespace skein::idl
