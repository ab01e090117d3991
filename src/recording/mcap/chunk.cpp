#include "recording/mcap/chunk.hpp"

#include <algorithm>

#include "recording/mcap/record_writer.hpp"

namespace skein::recording {

std::size_t record_size(const Message& message) {
  return kRecordHeader + kMessageFields + message.data.size();
}

void Chunk::add(const Message& message) {
  start_ = empty() ? message.log_time : std::min(start_, message.log_time);
  end_ = empty() ? message.log_time : std::max(end_, message.log_time);
  if (index_.size() <= message.channel) index_.resize(message.channel + std::size_t{1});
  auto& index = index_[message.channel];
  if (index.empty()) channels_.push_back(message.channel);
  index.push_back({message.log_time, records_.size()});

  RecordWriter writer(records_);
  writer.number(static_cast<std::uint8_t>(Opcode::Message));
  writer.number(std::uint64_t{kMessageFields + message.data.size()});
  writer.number(message.channel);
  writer.number(message.sequence);
  writer.number(message.log_time);
  writer.number(message.publish_time);
  records_.append(message.data);
}

void Chunk::clear() {
  records_.clear();
  for (const auto channel : channels_) index_[channel].clear();
  channels_.clear();
}

}  // namespace skein::recording
