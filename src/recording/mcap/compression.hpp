#pragma once

#include <memory>
#include <span>

#include "skein/detail/bytes.hpp"

struct ZSTD_CCtx_s;

namespace skein::recording {

inline constexpr const char* kZstd = "zstd";

/// Compresses by zstd. Not thread-safe.
class Compressor {
 public:
  /// Throws InvalidArgument for a level that zstd does not have.
  explicit Compressor(int level);
  ~Compressor();

  /// Appends it. Gives false, and appends nothing, where it would not become smaller.
  bool compress(std::span<const std::byte> from, Bytes& to);

 private:
  std::unique_ptr<ZSTD_CCtx_s, void (*)(ZSTD_CCtx_s*)> context_;
};

/// Exactly `to.size()` bytes. False if it is no zstd, or of another size.
bool decompress(std::span<const std::byte> from, std::span<std::byte> to);

/// The checksum of MCAP, which is that of gzip.
std::uint32_t crc32(std::span<const std::byte> bytes);

}  // namespace skein::recording
