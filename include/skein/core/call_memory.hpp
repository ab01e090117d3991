#pragma once

#include <memory>
#include <memory_resource>
#include <utility>

namespace skein {

/// Memory for what comes and goes with each call: blocks are kept and handed out again, so that a
/// steady stream of calls takes none from the heap. Bounded: what is larger than 1 KiB, or freed
/// beyond what is kept (256 blocks of each size), goes back to the heap. Lives as long as the
/// process. Thread-safe.
std::pmr::memory_resource& call_memory() noexcept;

/// `std::make_shared` in call_memory().
template <class T, class... Arguments>
std::shared_ptr<T> make_shared_in_call_memory(Arguments&&... arguments) {
  return std::allocate_shared<T>(std::pmr::polymorphic_allocator<T>(&call_memory()),
                                 std::forward<Arguments>(arguments)...);
}

}  // namespace skein
