#include "recording/mcap/reader.hpp"

#include <algorithm>
#include <charconv>

#include "core/printable.hpp"
#include "core/suggestion.hpp"
#include "recording/mcap/compression.hpp"
#include "recording/mcap/message_cursor.hpp"
#include "skein/error.hpp"

namespace skein::recording {
namespace {

/// An empty file is one that was cut.
void check_magic(const InputFile& file) {
  const Bytes start = file.read(0, std::min<std::uint64_t>(file.size(), kMagic.size()));
  if (std::ranges::equal(std::span<const std::byte>(start),
                         std::span(kMagic).first(start.size()))) {
    return;
  }
  throw InvalidArgument("'" + printable(file.path()) +
                        "' is no recording: it does not begin as MCAP files do");
}

FileIndex read_index(const InputFile& file, std::size_t memory) {
  check_magic(file);
  std::string why;
  try {
    if (auto index = read_summary(file, memory)) return std::move(*index);
  } catch (const MalformedRecord& malformed) {
    why = malformed.what();
  }
  FileIndex index = scan(file, memory);
  if (!why.empty()) index.add_problem("its index is not used: " + why);
  return index;
}

}  // namespace

Messages::Messages(std::unique_ptr<MessageCursor> cursor) : cursor_(std::move(cursor)) {}
Messages::Messages(Messages&& other) noexcept = default;
Messages::~Messages() = default;
std::optional<Message> Messages::next() { return cursor_->next(); }
const std::vector<std::string>& Messages::problems() const { return cursor_->problems(); }

struct Reader::State {
  State(std::string path, const ReaderOptions& options)
      : file(std::move(path)), memory(options.memory), index(read_index(file, memory)) {}

  InputFile file;
  std::size_t memory;
  FileIndex index;
};

Reader::Reader(std::string path, const ReaderOptions& options)
    : state_(std::make_unique<State>(std::move(path), options)) {}
Reader::~Reader() = default;

bool Reader::is_complete() const { return state_->index.is_complete; }
const std::vector<std::string>& Reader::problems() const { return state_->index.problems; }
const std::map<std::uint16_t, Schema>& Reader::schemas() const { return state_->index.schemas; }
const std::map<std::uint16_t, Channel>& Reader::channels() const { return state_->index.channels; }
const std::vector<Metadata>& Reader::metadata() const { return state_->index.metadata; }

const std::map<std::uint16_t, std::uint64_t>& Reader::message_counts() const {
  return state_->index.message_counts;
}

std::uint64_t Reader::message_count() const {
  std::uint64_t all = 0;
  for (const auto& [channel, count] : message_counts()) all += count;
  return all;
}

std::optional<std::pair<std::uint64_t, std::uint64_t>> Reader::times() const {
  std::optional<std::pair<std::uint64_t, std::uint64_t>> times;
  for (const ChunkPlace& chunk : state_->index.chunks) {
    if (!times) times.emplace(chunk.start, chunk.end);
    times = {std::min(times->first, chunk.start), std::max(times->second, chunk.end)};
  }
  return times;
}

std::map<std::string, std::uint64_t> Reader::dropped() const {
  std::map<std::string, std::uint64_t> dropped;
  for (const Metadata& entry : metadata()) {
    if (entry.name != kDropsName) continue;
    for (const auto& [topic, text] : entry.values) {
      std::from_chars(text.data(), text.data() + text.size(), dropped[topic]);
    }
  }
  return dropped;
}

std::vector<ClockStep> Reader::clock_steps() const {
  std::vector<ClockStep> steps;
  for (const Metadata& entry : metadata()) {
    if (entry.name != kClockStepName) continue;
    const auto read = [&](const char* name, auto& number) {
      const auto found = entry.values.find(name);
      if (found == entry.values.end()) return;
      const std::string& text = found->second;
      std::from_chars(text.data(), text.data() + text.size(), number);
    };
    read("at_ns", steps.emplace_back().at);
    read("by_ns", steps.back().by);
  }
  return steps;
}

std::vector<std::string> Reader::attachments() const {
  std::vector<std::string> names;
  for (const AttachmentPlace& place : state_->index.attachments) names.push_back(place.name);
  return names;
}

Attachment Reader::attachment(const std::string& name) const {
  const auto refuse = [&](const std::string& why) {
    throw InvalidArgument("the attachment '" + printable(name) + "' of the recording '" +
                          printable(state_->file.path()) + "' " + why);
  };
  const auto& places = state_->index.attachments;
  const auto found = std::ranges::find(places, name, &AttachmentPlace::name);
  if (found == places.end()) refuse("is not there" + suggestion(name, attachments()));
  Attachment attachment;
  try {
    const Bytes bytes = state_->file.read(found->offset, found->length);
    RecordReader reader(bytes);
    const auto record = next_record(reader);
    if (!record) throw MalformedRecord("its record is not whole");
    RecordReader fields(record->fields);
    attachment.log_time = fields.number<std::uint64_t>();
    attachment.create_time = fields.number<std::uint64_t>();
    attachment.name = fields.text();
    attachment.media_type = fields.text();
    const auto data = fields.bytes(fields.number<std::uint64_t>());
    attachment.data.assign(reinterpret_cast<const char*>(data.data()), data.size());
    const auto crc = fields.number<std::uint32_t>();
    const auto checked = record->fields.first(record->fields.size() - fields.size() - sizeof crc);
    if (crc != 0 && crc != crc32(checked)) throw MalformedRecord("its checksum is wrong");
  } catch (const MalformedRecord& malformed) {
    refuse("is damaged: " + std::string(malformed.what()));
  }
  return attachment;
}

Messages Reader::messages(const Selection& selection) const {
  std::set<std::uint16_t> wanted;
  std::vector<std::string> topics;
  for (const auto& [id, channel] : channels()) {
    topics.push_back(channel.topic);
    if (selection.topics.empty() || std::ranges::count(selection.topics, channel.topic) > 0) {
      wanted.insert(id);
    }
  }
  for (const std::string& topic : selection.topics) {
    if (std::ranges::count(topics, topic) == 0) {
      throw InvalidArgument("the recording '" + printable(state_->file.path()) +
                            "' has no topic '" + printable(topic) + "'" +
                            suggestion(topic, topics));
    }
  }
  return Messages(std::make_unique<MessageCursor>(state_->file, state_->index, std::move(wanted),
                                                  selection, state_->memory));
}

}  // namespace skein::recording
