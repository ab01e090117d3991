#pragma once

#include <memory>
#include <memory_resource>
#include <utility>

#include "skein/detail/version.hpp"

namespace skein {

/// Memory for objects that are made for each call. Freed blocks are kept and reused, so that a
/// steady stream of calls takes nothing from the heap. Bounded: blocks larger than 1 KiB, and more
/// than 256 free blocks of one size, go back to the heap. Lives as long as the process.
/// Thread-safe.
std::pmr::memory_resource& call_memory() noexcept;

/// `std::make_shared` in call_memory().
template <class T, class... Arguments>
std::shared_ptr<T> make_shared_in_call_memory(Arguments&&... arguments) {
  return std::allocate_shared<T>(std::pmr::polymorphic_allocator<T>(&call_memory()),
                                 std::forward<Arguments>(arguments)...);
}

}  // namespace skein
