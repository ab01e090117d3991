#include <algorithm>

#include "recording/mcap/chunk_reader.hpp"
#include "recording/mcap/compression.hpp"
#include "recording/mcap/file_index.hpp"

namespace skein::recording {
namespace {

constexpr std::uint64_t kEnd = kRecordHeader + kFooterFields + kMagic.size();

/// The summary's records; nothing if there is none.
std::optional<Bytes> summary_of(const InputFile& file, std::size_t memory) {
  if (file.size() < kMagic.size() + kEnd) return std::nullopt;
  const std::uint64_t footer = file.size() - kEnd;
  const Bytes end = file.read(footer, kEnd);
  if (!std::ranges::equal(std::span<const std::byte>(end).last(kMagic.size()), kMagic)) {
    return std::nullopt;
  }
  RecordReader reader(end);
  const auto record = next_record(reader);
  if (!record || record->opcode != static_cast<std::uint8_t>(Opcode::Footer)) return std::nullopt;
  RecordReader fields(record->fields);
  const auto start = fields.number<std::uint64_t>();
  const auto offsets = fields.number<std::uint64_t>();
  const auto crc = fields.number<std::uint32_t>();
  if (start == 0 || start > footer || footer - start > memory) return std::nullopt;
  Bytes summary = file.read(start, footer - start + kEnd);
  const auto checked = std::span<const std::byte>(summary).first(footer - start + kRecordHeader +
                                                                 kFooterFields - sizeof crc);
  if (crc != 0 && crc32(checked) != crc) throw MalformedRecord("its checksum is wrong");
  const bool has_offsets = offsets >= start && offsets <= footer;
  summary.resize((has_offsets ? offsets : footer) - start);
  return summary;
}

struct Statistics {
  explicit Statistics(RecordReader fields) : messages(fields.number<std::uint64_t>()) {
    fields.bytes(2 + 4 + 4 + 4 + 4 + 8 + 8);
    for (RecordReader pairs = fields.part(); pairs.size() > 0;) {
      const auto channel = pairs.number<std::uint16_t>();
      counts[channel] = pairs.number<std::uint64_t>();
    }
  }

  std::uint64_t messages;
  std::map<std::uint16_t, std::uint64_t> counts;
};

ChunkPlace read_chunk_index(RecordReader fields) {
  ChunkPlace place;
  place.start = fields.number<std::uint64_t>();
  place.end = fields.number<std::uint64_t>();
  place.offset = fields.number<std::uint64_t>();
  place.length = fields.number<std::uint64_t>();
  for (RecordReader pairs = fields.part(); pairs.size() > 0;) {
    place.channels.insert(pairs.number<std::uint16_t>());
    pairs.number<std::uint64_t>();
  }
  return place;
}

AttachmentPlace read_attachment_index(RecordReader fields) {
  AttachmentPlace place;
  place.offset = fields.number<std::uint64_t>();
  place.length = fields.number<std::uint64_t>();
  fields.bytes(8 + 8 + 8);
  place.name = fields.text();
  return place;
}

/// An index may name a place once: a small file must not stand for a large one.
void check_distinct(const std::vector<ChunkPlace>& places) {
  std::vector<std::pair<std::uint64_t, std::uint64_t>> ranges;
  ranges.reserve(places.size());
  for (const ChunkPlace& place : places) ranges.emplace_back(place.offset, place.length);
  std::ranges::sort(ranges);
  for (std::size_t i = 1; i < ranges.size(); ++i) {
    if (ranges[i].first - ranges[i - 1].first < ranges[i - 1].second) {
      throw MalformedRecord("two chunks lie at the same place");
    }
  }
}

}  // namespace

std::optional<FileIndex> read_summary(const InputFile& file, std::size_t memory) {
  const auto summary = summary_of(file, memory);
  if (!summary) return std::nullopt;
  FileIndex index;
  index.is_complete = true;
  std::optional<Statistics> statistics;
  std::vector<ChunkPlace> metadata;
  RecordReader records(*summary);
  while (const auto record = next_record(records)) {
    const RecordReader fields(record->fields);
    switch (static_cast<Opcode>(record->opcode)) {
      case Opcode::Schema:
        index.add_schema(fields);
        break;
      case Opcode::Channel:
        index.add_channel(fields);
        break;
      case Opcode::Statistics:
        statistics.emplace(fields);
        break;
      case Opcode::ChunkIndex:
        index.chunks.push_back(read_chunk_index(fields));
        break;
      case Opcode::AttachmentIndex:
        index.attachments.push_back(read_attachment_index(fields));
        break;
      case Opcode::MetadataIndex: {
        RecordReader place = fields;
        const auto offset = place.number<std::uint64_t>();
        metadata.push_back({true, 0, 0, offset, place.number<std::uint64_t>(), {}});
        break;
      }
      default:
        break;
    }
  }
  // Without an index of chunks messages may lie anywhere; without statistics it is not known of
  // which channels.
  if (!statistics || (index.chunks.empty() && statistics->messages > 0)) return std::nullopt;
  if (statistics->counts.empty() && statistics->messages > 0) return std::nullopt;
  index.message_counts = statistics->counts;
  check_distinct(index.chunks);
  check_distinct(metadata);
  for (const ChunkPlace& place : metadata) {
    if (place.length > kMostKept) throw MalformedRecord("a metadata record is too long");
    const Bytes bytes = file.read(place.offset, place.length);
    RecordReader reader(bytes);
    if (const auto record = next_record(reader)) index.add_metadata(RecordReader(record->fields));
  }
  return index;
}

}  // namespace skein::recording
