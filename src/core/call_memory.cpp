#include "skein/detail/call_memory.hpp"

#include <array>
#include <mutex>
#include <new>

namespace skein {
namespace {

constexpr std::size_t kStep = 64;
constexpr std::size_t kGreatest = 1024;
#ifdef __SANITIZE_ADDRESS__  // it finds who uses a block after its end, unless the block is handed
                             // out again
constexpr std::size_t kMaxKept = 0;
#else
constexpr std::size_t kMaxKept = 256;
#endif

/// Freed blocks by size, each a multiple of kStep, linked through themselves.
class Recycler final : public std::pmr::memory_resource {
 private:
  struct Block {
    Block* next;
  };
  struct Kept {
    std::mutex mutex;
    Block* first = nullptr;
    std::size_t count = 0;
  };

  static bool is_kept(std::size_t size, std::size_t alignment) {
    return size <= kGreatest && alignment <= __STDCPP_DEFAULT_NEW_ALIGNMENT__;
  }
  static std::size_t index_of(std::size_t size) { return size == 0 ? 0 : (size - 1) / kStep; }

  void* do_allocate(std::size_t size, std::size_t alignment) override {
    if (!is_kept(size, alignment)) return ::operator new(size, std::align_val_t(alignment));
    Kept& kept = kept_[index_of(size)];
    {
      std::lock_guard lock(kept.mutex);
      if (Block* const block = kept.first) {
        kept.first = block->next;
        --kept.count;
        return block;
      }
    }
    return ::operator new((index_of(size) + 1) * kStep);
  }

  void do_deallocate(void* memory, std::size_t size, std::size_t alignment) override {
    if (!is_kept(size, alignment)) return ::operator delete(memory, std::align_val_t(alignment));
    Kept& kept = kept_[index_of(size)];
    {
      std::lock_guard lock(kept.mutex);
      if (kept.count < kMaxKept) {
        kept.first = new (memory) Block{kept.first};
        ++kept.count;
        return;
      }
    }
    ::operator delete(memory);
  }

  bool do_is_equal(const std::pmr::memory_resource& other) const noexcept override {
    return this == &other;
  }

  std::array<Kept, kGreatest / kStep> kept_;
};

}  // namespace

std::pmr::memory_resource& call_memory() noexcept {
  static auto& memory =
      *new Recycler;  // never destroyed: vendors' threads may free until the very end
  return memory;
}

}  // namespace skein
