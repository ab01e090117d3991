#include "recording/mcap/chunk_reader.hpp"

#include <algorithm>

#include "core/printable.hpp"
#include "recording/mcap/compression.hpp"

namespace skein::recording {

ChunkHead::ChunkHead(RecordReader& fields)
    : start(fields.number<std::uint64_t>()),
      end(fields.number<std::uint64_t>()),
      uncompressed_size(fields.number<std::uint64_t>()),
      crc(fields.number<std::uint32_t>()),
      compression(fields.text()),
      compressed_size(fields.number<std::uint64_t>()) {}

Allowance::Allowance(const InputFile& file, std::size_t most)
    : memory(std::min<std::uint64_t>(most, (std::uint64_t{64} << 20) + 100 * file.size())),
      total((std::uint64_t{256} << 20) + 1000 * file.size()) {}

void Allowance::check(std::uint64_t read) const {
  if (read <= total) return;
  throw MalformedRecord("the chunks before it have " + std::to_string(read) +
                        " bytes, a thousand times as many as the file");
}

Bytes read_chunk(const InputFile& file, const ChunkPlace& place, std::size_t memory) {
  const auto refuse_larger = [&](std::uint64_t size) {
    if (size > memory) {
      throw MalformedRecord("it takes " + std::to_string(size) + " bytes of memory, and " +
                            std::to_string(memory) + " are allowed");
    }
  };
  refuse_larger(place.length);
  Bytes raw = file.read(place.offset, place.length);
  if (!place.is_chunk) return raw;

  RecordReader reader(raw);
  const auto record = next_record(reader);
  if (!record || record->opcode != static_cast<std::uint8_t>(Opcode::Chunk)) {
    throw MalformedRecord("no chunk stands there");
  }
  RecordReader fields(record->fields);
  const ChunkHead head(fields);
  const auto compressed = fields.bytes(head.compressed_size);
  refuse_larger(head.uncompressed_size);
  Bytes records;
  if (head.compression.empty()) {
    records.append(compressed);
  } else if (head.compression == kZstd) {
    records.resize(head.uncompressed_size);
    if (!decompress(compressed, {records.data(), records.size()})) {
      throw MalformedRecord("it cannot be decompressed to " +
                            std::to_string(head.uncompressed_size) + " bytes");
    }
  } else {
    throw MalformedRecord("it is compressed by '" + printable(head.compression) +
                          "'; zstd and none can be read");
  }
  if (head.crc != 0 && head.crc != crc32(records)) throw MalformedRecord("its checksum is wrong");
  return records;
}

Message read_message(RecordReader fields) {
  Message message;
  message.channel = fields.number<std::uint16_t>();
  message.sequence = fields.number<std::uint32_t>();
  message.log_time = fields.number<std::uint64_t>();
  message.publish_time = fields.number<std::uint64_t>();
  message.data = fields.bytes(fields.size());
  return message;
}

}  // namespace skein::recording
