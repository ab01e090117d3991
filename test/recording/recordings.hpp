#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "recording/mcap/reader.hpp"
#include "recording/mcap/writer.hpp"
#include "test/tools/temporary_folder.hpp"

namespace skein::test {

inline std::span<const std::byte> bytes_of(std::string_view text) {
  return std::as_bytes(std::span(text));
}

inline std::string operator/(const TemporaryFolder& folder, std::string_view name) {
  return (folder.path() / name).string();
}

/// A message, with its data kept.
struct KeptMessage {
  std::string topic;
  std::uint32_t sequence;
  std::uint64_t log_time;
  std::string data;

  bool operator==(const KeptMessage&) const = default;
};

inline std::vector<KeptMessage> all_messages(const recording::Reader& reader,
                                             const recording::Selection& selection = {}) {
  std::vector<KeptMessage> kept;
  auto messages = reader.messages(selection);
  while (const auto message = messages.next()) {
    kept.push_back({reader.channels().at(message->channel).topic,
                    message->sequence,
                    message->log_time,
                    {reinterpret_cast<const char*>(message->data.data()), message->data.size()}});
  }
  return kept;
}

inline std::string content_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// A new file: ext4 would write one that is emptied first to the disk at once.
inline void put(const std::string& path, std::string_view content) {
  std::filesystem::remove(path);
  std::ofstream(path, std::ios::binary).write(content.data(), std::streamsize(content.size()));
}

}  // namespace skein::test
