#include "recording/mcap/compression.hpp"

#include <libdeflate.h>
#include <zstd.h>

#include <string>

#include "skein/error.hpp"

namespace skein::recording {

Compressor::Compressor(int level)
    : context_(ZSTD_createCCtx(), [](ZSTD_CCtx_s* context) { ZSTD_freeCCtx(context); }) {
  if (level < ZSTD_minCLevel() || level > ZSTD_maxCLevel() || level == 0) {
    throw InvalidArgument("zstd has no level " + std::to_string(level) + "; take 1 to " +
                          std::to_string(ZSTD_maxCLevel()) +
                          ", or a negative one, which is faster and compresses less");
  }
  ZSTD_CCtx_setParameter(context_.get(), ZSTD_c_compressionLevel, level);
}

Compressor::~Compressor() = default;

bool Compressor::compress(std::span<const std::byte> from, Bytes& to) {
  const std::size_t start = to.size();
  const std::size_t room = ZSTD_compressBound(from.size());
  to.resize(start + room);
  const std::size_t size =
      ZSTD_compress2(context_.get(), to.data() + start, room, from.data(), from.size());
  const bool smaller = ZSTD_isError(size) == 0 && size < from.size();
  to.resize(smaller ? start + size : start);
  return smaller;
}

bool decompress(std::span<const std::byte> from, std::span<std::byte> to) {
  return ZSTD_decompress(to.data(), to.size(), from.data(), from.size()) == to.size();
}

std::uint32_t crc32(std::span<const std::byte> bytes) {
  return ::libdeflate_crc32(0, bytes.data(), bytes.size());
}

}  // namespace skein::recording
