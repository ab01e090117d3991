#include "recording/mcap/recording_file.hpp"

#include <algorithm>

namespace skein::recording {
namespace {

void write_schema(Bytes& to, const Schema& schema) {
  RecordWriter writer(to);
  writer.record(Opcode::Schema, [&] {
    writer.number(schema.id);
    writer.text(schema.name);
    writer.text(schema.encoding);
    writer.text(schema.data);
  });
}

void write_channel(Bytes& to, const Channel& channel) {
  RecordWriter writer(to);
  writer.record(Opcode::Channel, [&] {
    writer.number(channel.id);
    writer.number(channel.schema);
    writer.text(channel.topic);
    writer.text(channel.message_encoding);
    writer.text_map(channel.metadata);
  });
}

std::span<const std::byte> bytes_of(const Bytes& bytes, std::size_t from) {
  return std::span<const std::byte>(bytes).subspan(from);
}

}  // namespace

RecordingFile::RecordingFile(std::string path, const std::string& library,
                             std::optional<int> zstd_level)
    : file_(std::move(path)) {
  if (zstd_level) compressor_.emplace(*zstd_level);
  RecordWriter writer = begin();
  piece_.append(kMagic);
  writer.record(Opcode::Header, [&] {
    writer.text("");
    writer.text(library);
  });
  end();
}

RecordWriter RecordingFile::begin() {
  piece_.clear();
  return RecordWriter(piece_);
}

std::optional<std::uint64_t> RecordingFile::start() const {
  return chunk_count_ == 0 ? std::nullopt : std::optional(start_);
}

void RecordingFile::write(const Schema& schema) {
  begin();
  write_schema(piece_, schema);
  end();
  schemas_.append(piece_);
  schema_ids_.insert(schema.id);
}

void RecordingFile::write(const Channel& channel) {
  begin();
  write_channel(piece_, channel);
  end();
  channels_.append(piece_);
  messages_[channel.id] = 0;
}

void RecordingFile::write(const Attachment& attachment) {
  const std::uint64_t offset = file_.size();
  RecordWriter writer = begin();
  const std::uint64_t length = writer.record(Opcode::Attachment, [&] {
    writer.number(attachment.log_time);
    writer.number(attachment.create_time);
    writer.text(attachment.name);
    writer.text(attachment.media_type);
    writer.number(std::uint64_t{attachment.data.size()});
    piece_.append(std::as_bytes(std::span(attachment.data)));
    writer.number(crc32(bytes_of(piece_, kRecordHeader)));
  });
  end();
  RecordWriter index(attachment_indexes_);
  index.record(Opcode::AttachmentIndex, [&] {
    index.number(offset);
    index.number(length);
    index.number(attachment.log_time);
    index.number(attachment.create_time);
    index.number(std::uint64_t{attachment.data.size()});
    index.text(attachment.name);
    index.text(attachment.media_type);
  });
  ++attachment_count_;
}

void RecordingFile::write(const Metadata& metadata) {
  const std::uint64_t offset = file_.size();
  RecordWriter writer = begin();
  const std::uint64_t length = writer.record(Opcode::Metadata, [&] {
    writer.text(metadata.name);
    writer.text_map(metadata.values);
  });
  end();
  RecordWriter index(metadata_indexes_);
  index.record(Opcode::MetadataIndex, [&] {
    index.number(offset);
    index.number(length);
    index.text(metadata.name);
  });
  ++metadata_count_;
}

void RecordingFile::write(const Chunk& chunk) {
  const std::uint64_t offset = file_.size();
  const std::span<const std::byte> records = chunk.records();
  RecordWriter writer = begin();
  std::string compression;
  std::uint64_t compressed_size = records.size();
  const std::uint64_t length = writer.record(Opcode::Chunk, [&] {
    writer.number(chunk.start());
    writer.number(chunk.end());
    writer.number(std::uint64_t{records.size()});
    writer.number(crc32(records));
    const std::size_t variable_part = piece_.size();
    writer.text(kZstd);
    writer.number(std::uint64_t{0});
    const std::size_t start = piece_.size();
    if (compressor_ && compressor_->compress(records, piece_)) {
      compression = kZstd;
      compressed_size = piece_.size() - start;
      writer.set_number(start - sizeof(std::uint64_t), compressed_size);
      return;
    }
    piece_.resize(variable_part);
    writer.text("");
    writer.number(compressed_size);
    piece_.append(records);
  });

  RecordWriter index(chunk_indexes_);
  const std::size_t index_start = chunk_indexes_.size();
  const std::size_t message_indexes = piece_.size();
  index.record(Opcode::ChunkIndex, [&] {
    index.number(chunk.start());
    index.number(chunk.end());
    index.number(offset);
    index.number(length);
    index.number(static_cast<std::uint32_t>(chunk.channels().size() *
                                            (sizeof(std::uint16_t) + sizeof(std::uint64_t))));
    for (const std::uint16_t channel : chunk.channels()) {
      index.number(channel);
      index.number(std::uint64_t{offset + piece_.size()});
      const auto& entries = chunk.index(channel);
      const auto raw = std::as_bytes(std::span(entries));
      writer.record(Opcode::MessageIndex, [&] {
        writer.number(channel);
        writer.number(static_cast<std::uint32_t>(raw.size()));
        piece_.append(raw);
      });
    }
    index.number(std::uint64_t{piece_.size() - message_indexes});
    index.text(compression);
    index.number(compressed_size);
    index.number(std::uint64_t{records.size()});
  });
  try {
    end();
  } catch (...) {
    chunk_indexes_.resize(index_start);
    throw;
  }
  start_ = chunk_count_ == 0 ? chunk.start() : std::min(start_, chunk.start());
  end_ = chunk_count_ == 0 ? chunk.end() : std::max(end_, chunk.end());
  ++chunk_count_;
  for (const auto channel : chunk.channels()) messages_[channel] += chunk.index(channel).size();
}

void RecordingFile::write_statistics() {
  statistics_.clear();
  RecordWriter writer(statistics_);
  writer.record(Opcode::Statistics, [&] {
    std::uint64_t all = 0;
    for (const auto& [channel, count] : messages_) all += count;
    writer.number(all);
    writer.number(static_cast<std::uint16_t>(schema_ids_.size()));
    writer.number(static_cast<std::uint32_t>(messages_.size()));
    writer.number(attachment_count_);
    writer.number(metadata_count_);
    writer.number(chunk_count_);
    writer.number(start_);
    writer.number(end_);
    writer.number(static_cast<std::uint32_t>(messages_.size() *
                                             (sizeof(std::uint16_t) + sizeof(std::uint64_t))));
    for (const auto& [channel, count] : messages_) {
      writer.number(channel);
      writer.number(count);
    }
  });
}

void RecordingFile::finish() {
  write_statistics();
  RecordWriter writer = begin();
  writer.record(Opcode::DataEnd, [&] { writer.number(std::uint32_t{0}); });
  const std::size_t summary = piece_.size();
  const std::uint64_t summary_start = file_.size() + summary;

  Bytes offsets;
  RecordWriter offset_writer(offsets);
  const auto group = [&](Opcode opcode, const Bytes& records) {
    if (records.empty()) return;
    offset_writer.record(Opcode::SummaryOffset, [&] {
      offset_writer.number(static_cast<std::uint8_t>(opcode));
      offset_writer.number(std::uint64_t{file_.size() + piece_.size()});
      offset_writer.number(std::uint64_t{records.size()});
    });
    piece_.append(records);
  };
  group(Opcode::Schema, schemas_);
  group(Opcode::Channel, channels_);
  group(Opcode::Statistics, statistics_);
  group(Opcode::ChunkIndex, chunk_indexes_);
  group(Opcode::AttachmentIndex, attachment_indexes_);
  group(Opcode::MetadataIndex, metadata_indexes_);
  const std::uint64_t offsets_start = file_.size() + piece_.size();
  piece_.append(offsets);

  writer.record(Opcode::Footer, [&] {
    writer.number(summary_start);
    writer.number(offsets_start);
    writer.number(std::uint32_t{0});
  });
  const std::size_t crc = piece_.size() - sizeof(std::uint32_t);
  writer.set_number(crc, crc32(bytes_of(piece_, summary).first(crc - summary)));
  piece_.append(kMagic);
  end();
  file_.sync();
}

}  // namespace skein::recording
