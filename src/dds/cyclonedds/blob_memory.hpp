#pragma once

#include <cstddef>

namespace skein::dds::cyclonedds {

/// Memory for blobs of `size` bytes in all. That of large ones is kept for the next: the C library
/// gives a freed mebibyte back to the kernel, and to get it again costs some hundred page faults,
/// more than everything else in a call. At most 16 MiB are kept. Thread-safe.
void* allocate_blob(std::size_t size);

/// `size` as it was allocated.
void free_blob_memory(void* memory, std::size_t size) noexcept;

}  // namespace skein::dds::cyclonedds
