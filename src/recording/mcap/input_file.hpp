#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "core/system/file_descriptor.hpp"
#include "skein/detail/bytes.hpp"

namespace skein::recording {

/// A file that is read anywhere. Thread-safe. Not mapped: a file that becomes shorter while it is
/// read is then an error, not a signal.
class InputFile {
 public:
  /// Throws InvalidArgument if it cannot be opened.
  explicit InputFile(std::string path);

  const std::string& path() const noexcept { return path_; }
  /// When it was opened.
  std::uint64_t size() const noexcept { return size_; }

  /// Throws MalformedRecord if the file has no such bytes, or cannot be read.
  Bytes read(std::uint64_t offset, std::uint64_t length) const;

 private:
  std::string path_;
  FileDescriptor file_;
  std::uint64_t size_ = 0;
};

/// Reads forward, a large piece at once. Not thread-safe.
class InputWindow {
 public:
  explicit InputWindow(const InputFile& file) : file_(file) {}

  /// So many bytes, or what is left of the file. Valid until the next call. Throws MalformedRecord.
  std::span<const std::byte> at(std::uint64_t offset, std::size_t length);

 private:
  const InputFile& file_;
  Bytes piece_;
  std::uint64_t start_ = 0;
};

}  // namespace skein::recording
