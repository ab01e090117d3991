#include "blob_memory.hpp"

#include <array>
#include <bit>
#include <mutex>
#include <new>
#include <vector>

namespace skein::dds::cyclonedds {
namespace {

constexpr std::size_t kLeastKept = 64 << 10;
constexpr std::size_t kGreatestKept = 4 << 20;
constexpr std::size_t kMaxKept = 16 << 20;

/// Freed memory by size, each a power of two.
class Kept {
 public:
  Kept() {
    for (auto& list : lists_) list.reserve(kMaxKept / kLeastKept);
  }

  void* take(std::size_t size) {
    std::lock_guard lock(mutex_);
    auto& list = list_of(size);
    if (list.empty()) return nullptr;
    void* memory = list.back();
    list.pop_back();
    total_ -= size;
    return memory;
  }

  bool keep(void* memory, std::size_t size) noexcept {
    std::lock_guard lock(mutex_);
    if (total_ + size > kMaxKept) return false;
    list_of(size).push_back(memory);
    total_ += size;
    return true;
  }

 private:
  std::vector<void*>& list_of(std::size_t size) { return lists_[std::countr_zero(size)]; }

  std::mutex mutex_;
  std::size_t total_ = 0;
  std::array<std::vector<void*>, std::countr_zero(kGreatestKept) + 1> lists_;
};

/// Never destroyed: Cyclone's threads may free samples until the very end.
Kept& kept() {
  static auto* kept = new Kept;
  return *kept;
}

bool is_kept(std::size_t size) { return size >= kLeastKept && size <= kGreatestKept; }

}  // namespace

void* allocate_blob(std::size_t size) {
  if (!is_kept(size)) return ::operator new(size);
  const std::size_t room = std::bit_ceil(size);
  void* memory = kept().take(room);
  return memory != nullptr ? memory : ::operator new(room);
}

void free_blob_memory(void* memory, std::size_t size) noexcept {
  if (!is_kept(size) || !kept().keep(memory, std::bit_ceil(size))) ::operator delete(memory);
}

}  // namespace skein::dds::cyclonedds
