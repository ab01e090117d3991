#include "recording/mcap/record_writer.hpp"

namespace skein::recording {

void RecordWriter::text_map(const std::map<std::string, std::string>& values) {
  const std::size_t start = bytes_.size();
  number(std::uint32_t{0});
  for (const auto& [key, value] : values) {
    text(key);
    text(value);
  }
  set_number(start, static_cast<std::uint32_t>(bytes_.size() - start - sizeof(std::uint32_t)));
}

}  // namespace skein::recording
