#pragma once

#include "recording/mcap/file_index.hpp"
#include "skein/detail/bytes.hpp"

namespace skein::recording {

/// What stands in a chunk record before its records.
struct ChunkHead {
  explicit ChunkHead(RecordReader& fields);

  std::uint64_t start;
  std::uint64_t end;
  std::uint64_t uncompressed_size;
  std::uint32_t crc;
  std::string compression;
  std::uint64_t compressed_size;
};

/// Their records, decompressed and checked. Throws MalformedRecord if they are damaged,
/// compressed in another way than by zstd, or need more than `memory`.
Bytes read_chunk(const InputFile& file, const ChunkPlace& place, std::size_t memory);

/// How much a reader of this file takes: a small file must not stand for a large one. Messages of
/// zeros alone shrink to a thirty-thousandth, those of real systems to a tenth.
struct Allowance {
  Allowance(const InputFile& file, std::size_t memory);

  /// Throws MalformedRecord if so much has been read from chunks that the next is passed over.
  void check(std::uint64_t read) const;

  std::size_t memory;   ///< At a time.
  std::uint64_t total;  ///< From all chunks together.
};

/// A message record's fields.
Message read_message(RecordReader fields);

}  // namespace skein::recording
