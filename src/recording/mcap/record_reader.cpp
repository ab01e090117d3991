#include "recording/mcap/record_reader.hpp"

namespace skein::recording {

std::map<std::string, std::string> RecordReader::text_map() {
  std::map<std::string, std::string> values;
  for (RecordReader pairs = part(); pairs.size() > 0;) {
    std::string key = pairs.text();
    values[std::move(key)] = pairs.text();
  }
  return values;
}

std::optional<Record> next_record(RecordReader& bytes) {
  if (bytes.size() < kRecordHeader) return std::nullopt;
  const auto opcode = bytes.number<std::uint8_t>();
  const auto length = bytes.number<std::uint64_t>();
  if (length > bytes.size()) return std::nullopt;
  return Record{opcode, bytes.bytes(length)};
}

}  // namespace skein::recording
