#pragma once

#include <cstddef>
#include <utility>

#include "core/system/close_elsewhere.hpp"

namespace skein::same_host {

/// Memory without a name, mapped by those who have its descriptor. Nobody can shorten or lengthen
/// it, so that who uses it is never ended by the other side's doing. It is gone with the last of
/// them.
class SharedMemory {
 public:
  SharedMemory() = default;
  /// New, and zero. Throws Unavailable with the kernel's reason.
  static SharedMemory make(std::size_t size);
  /// What another process has made. Throws Unavailable where it is not of this size, or not sealed.
  static SharedMemory map(HandedOver descriptor, std::size_t size);

  /// The same, to be read alone, of whatever size up to `largest`; nobody but who has made it can
  /// write to it.
  static SharedMemory map_to_read(HandedOver descriptor, std::size_t largest);

  SharedMemory(SharedMemory&& other) noexcept { swap(other); }
  SharedMemory& operator=(SharedMemory&& other) noexcept {
    swap(other);
    return *this;
  }
  ~SharedMemory();

  std::byte* data() const noexcept { return data_; }
  std::size_t size() const noexcept { return size_; }
  int descriptor() const noexcept { return descriptor_.get(); }
  /// The mapping stays without it.
  FileDescriptor take_descriptor() noexcept { return std::move(descriptor_); }

 private:
  SharedMemory(FileDescriptor descriptor, std::size_t size, int access);
  void swap(SharedMemory& other) noexcept {
    std::swap(descriptor_, other.descriptor_);
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
  }

  FileDescriptor descriptor_;
  std::byte* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace skein::same_host
