#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "core/system/file_descriptor.hpp"

namespace skein::recording {

/// A file that grows by whole pieces: what append() has written is with the kernel, and what it
/// could not write whole is taken away again.
class OutputFile {
 public:
  /// Throws WriteFailed if it cannot be made, or is there already.
  explicit OutputFile(std::string path);

  /// Throws WriteFailed, with the reason and the remedy.
  void append(std::span<const std::byte> piece);

  /// Brings all of it to the disk. Throws as append() does.
  void sync();

  const std::string& path() const noexcept { return path_; }
  std::uint64_t size() const noexcept { return size_; }

 private:
  [[noreturn]] void fail(int error);

  std::string path_;
  FileDescriptor file_;
  std::uint64_t size_ = 0;
};

}  // namespace skein::recording
