#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

#include "core/system/file_descriptor.hpp"

namespace skein::launch {

/// A log file of bounded size. When it is full, `x.log` becomes `x.1.log`, this `x.2.log`, and so
/// on; the oldest goes. What an earlier run left is moved likewise, so that each run begins a file.
/// Only this user may read it.
class RotatingFile {
 public:
  struct Limits {
    std::uintmax_t size = 10 << 20;  ///< Bytes of one file.
    std::size_t files = 5;           ///< The current one among them; at least 1.
  };

  /// The folder exists. Nothing is written before the first line.
  RotatingFile(std::filesystem::path file, const Limits& limits);

  /// Adds a line whole; a line break follows it. False, with errno, where that fails.
  bool write(std::string_view line);

  const std::filesystem::path& path() const noexcept { return file_; }

 private:
  std::filesystem::path numbered(std::size_t number) const;
  bool rotate();

  std::filesystem::path file_;
  Limits limits_;
  FileDescriptor descriptor_;
  std::uintmax_t size_ = 0;
};

}  // namespace skein::launch
