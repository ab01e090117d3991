#include "recording/mcap/message_cursor.hpp"

#include <algorithm>

namespace skein::recording {
namespace {

constexpr std::size_t kMostCursorProblems = 100;

}  // namespace

MessageCursor::MessageCursor(const InputFile& file, const FileIndex& index,
                             std::set<std::uint16_t> channels, const Selection& selection,
                             std::size_t memory)
    : file_(file),
      channels_(std::move(channels)),
      first_(selection.first),
      last_(selection.last),
      allowance_(file, memory) {
  for (const ChunkPlace& place : index.chunks) {
    const bool in_time = place.end >= first_ && place.start <= last_;
    const bool wanted =
        place.channels.empty() ||
        std::ranges::any_of(place.channels, [this](auto id) { return channels_.contains(id); });
    if (in_time && wanted) places_.push_back(&place);
  }
  std::ranges::stable_sort(places_, {}, &ChunkPlace::start);
}

bool MessageCursor::comes_later(const LoadedChunk& a, const LoadedChunk& b) {
  const auto key = [](const LoadedChunk& chunk) {
    return std::pair(chunk.entries[chunk.next].log_time, chunk.offset);
  };
  return key(b) < key(a);
}

std::optional<Message> MessageCursor::next() {
  load_until_due();
  if (heap_.empty()) return std::nullopt;
  std::ranges::pop_heap(heap_, comes_later);
  LoadedChunk& chunk = heap_.back();
  RecordReader reader(
      std::span<const std::byte>(chunk.records).subspan(chunk.entries[chunk.next++].offset));
  const Message message = read_message(RecordReader(next_record(reader)->fields));
  if (chunk.next < chunk.entries.size()) {
    std::ranges::push_heap(heap_, comes_later);
  } else {
    loaded_ -= chunk.size();
    finished_ = std::move(chunk);
    heap_.pop_back();
  }
  return message;
}

/// Loads what begins before the next message. What there is no memory for comes later.
void MessageCursor::load_until_due() {
  while (next_place_ < places_.size()) {
    const ChunkPlace& place = *places_[next_place_];
    const bool is_due =
        heap_.empty() || place.start <= heap_.front().entries[heap_.front().next].log_time;
    if (!is_due || (!heap_.empty() && loaded_ >= allowance_.memory)) return;
    ++next_place_;
    try {
      load(place);
    } catch (const MalformedRecord& malformed) {
      if (problems_.size() < kMostCursorProblems) {
        problems_.push_back("the chunk at byte " + std::to_string(place.offset) +
                            " is passed over: " + malformed.what());
      }
    }
  }
}

void MessageCursor::load(const ChunkPlace& place) {
  LoadedChunk chunk;
  allowance_.check(read_);
  chunk.records = read_chunk(file_, place, allowance_.memory);
  read_ += chunk.records.size();
  chunk.offset = place.offset;
  RecordReader reader(chunk.records);
  while (const auto record = next_record(reader)) add_entry(chunk, *record);
  if (chunk.entries.empty()) return;
  std::ranges::stable_sort(chunk.entries, {}, &Entry::log_time);
  loaded_ += chunk.size();
  heap_.push_back(std::move(chunk));
  std::ranges::push_heap(heap_, comes_later);
}

void MessageCursor::add_entry(LoadedChunk& chunk, const Record& record) {
  if (record.opcode != static_cast<std::uint8_t>(Opcode::Message)) return;
  const Message message = read_message(RecordReader(record.fields));
  if (message.log_time < first_ || message.log_time > last_) return;
  if (!channels_.contains(message.channel)) return;
  const auto* start = record.fields.data() - kRecordHeader;
  chunk.entries.push_back(
      {message.log_time, static_cast<std::uint64_t>(start - chunk.records.data())});
}

}  // namespace skein::recording
