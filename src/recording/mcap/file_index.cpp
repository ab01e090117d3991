#include "recording/mcap/file_index.hpp"

namespace skein::recording {
namespace {

constexpr std::size_t kMostIndexProblems = 100;

void keep(FileIndex& index, std::uint64_t size) {
  if (index.kept + size > kMostKept) {
    throw MalformedRecord("with it, schemas, channels and metadata have more than " +
                          std::to_string(kMostKept) + " bytes");
  }
  index.kept += size;
}

}  // namespace

void FileIndex::add_schema(RecordReader fields) {
  keep(*this, fields.size());
  Schema schema;
  schema.id = fields.number<std::uint16_t>();
  schema.name = fields.text();
  schema.encoding = fields.text();
  schema.data = fields.text();
  if (schema.id != 0) schemas.try_emplace(schema.id, std::move(schema));
}

void FileIndex::add_channel(RecordReader fields) {
  keep(*this, fields.size());
  Channel channel;
  channel.id = fields.number<std::uint16_t>();
  channel.schema = fields.number<std::uint16_t>();
  channel.topic = fields.text();
  channel.message_encoding = fields.text();
  channel.metadata = fields.text_map();
  channels.try_emplace(channel.id, std::move(channel));
}

void FileIndex::add_problem(std::string problem) {
  if (problems.size() < kMostIndexProblems) problems.push_back(std::move(problem));
}

void FileIndex::add_metadata(RecordReader fields) {
  keep(*this, fields.size());
  Metadata entry;
  entry.name = fields.text();
  entry.values = fields.text_map();
  metadata.push_back(std::move(entry));
}

}  // namespace skein::recording
