#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <memory>
#include <span>
#include <utility>

#include "skein/detail/version.hpp"

namespace skein {

/// A growable byte buffer that is never zero-filled: messages are written once and read once, and
/// clearing a mebibyte before it is overwritten costs as much as a small call. Move-only.
class Bytes {
 public:
  Bytes() = default;
  explicit Bytes(std::span<const std::byte> content) { append(content); }
  Bytes(Bytes&& other) noexcept { swap(other); }
  Bytes& operator=(Bytes&& other) noexcept {
    Bytes taken(std::move(other));
    swap(taken);
    return *this;
  }

  std::byte* data() noexcept { return memory_.get(); }
  const std::byte* data() const noexcept { return memory_.get(); }
  std::size_t size() const noexcept { return size_; }
  std::size_t capacity() const noexcept { return capacity_; }
  bool empty() const noexcept { return size_ == 0; }
  operator std::span<const std::byte>() const noexcept { return {data(), size_}; }

  void clear() noexcept { size_ = 0; }

  /// Makes room for `capacity` bytes in total; keeps the content.
  void reserve(std::size_t capacity) {
    if (capacity <= capacity_) return;
    auto larger = std::make_unique_for_overwrite<std::byte[]>(capacity);
    if (size_ > 0) std::memcpy(larger.get(), memory_.get(), size_);
    memory_ = std::move(larger);
    capacity_ = capacity;
  }

  /// Sets the size; bytes beyond the old size are indeterminate.
  void resize(std::size_t size) {
    if (size > capacity_) reserve(std::max(size, capacity_ * 2));
    size_ = size;
  }

  void append(std::span<const std::byte> content) {
    if (content.empty()) return;
    const std::size_t at = size_;
    resize(at + content.size());
    std::memcpy(memory_.get() + at, content.data(), content.size());
  }

  void swap(Bytes& other) noexcept {
    std::swap(memory_, other.memory_);
    std::swap(size_, other.size_);
    std::swap(capacity_, other.capacity_);
  }

 private:
  std::unique_ptr<std::byte[]> memory_;
  std::size_t size_ = 0;
  std::size_t capacity_ = 0;
};

}  // namespace skein
