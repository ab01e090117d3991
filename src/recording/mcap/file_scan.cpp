#include <algorithm>

#include "recording/mcap/chunk_reader.hpp"
#include "recording/mcap/file_index.hpp"

namespace skein::recording {
namespace {

/// Of messages that lie one after the other in the file, so many bytes are read and ordered at
/// once.
constexpr std::uint64_t kLongestRun = std::uint64_t{1} << 20;
/// What is needed of records that are not kept whole.
constexpr std::size_t kHeadOfRecord = std::size_t{64} << 10;

class Scan {
 public:
  Scan(const InputFile& file, std::size_t memory)
      : file_(file), allowance_(file, memory), window_(file) {}

  FileIndex run() {
    std::uint64_t offset = kMagic.size();
    while (!ended_) {
      const auto head = window_.at(offset, kRecordHeader);
      if (head.size() < kRecordHeader) break;
      RecordReader reader(head);
      const auto opcode = static_cast<Opcode>(reader.number<std::uint8_t>());
      const auto length = reader.number<std::uint64_t>();
      if (opcode == Opcode{} || length > file_.size() - offset - kRecordHeader) break;
      try {
        visit(opcode, offset, length);
      } catch (const MalformedRecord& malformed) {
        index_.add_problem("the record at byte " + std::to_string(offset) +
                           " is passed over: " + malformed.what());
      }
      offset += kRecordHeader + length;
    }
    settle_chunk(!ended_);
    index_.is_complete = ended_;
    if (!ended_) {
      index_.add_problem("its end is missing: what is whole ends at byte " +
                         std::to_string(std::min(offset, file_.size())));
    }
    return std::move(index_);
  }

 private:
  void visit(Opcode opcode, std::uint64_t offset, std::uint64_t length) {
    if (opcode != Opcode::MessageIndex) settle_chunk(false);
    switch (opcode) {
      case Opcode::Schema:
        with_fields(offset, length, [this](RecordReader fields) { index_.add_schema(fields); });
        break;
      case Opcode::Channel:
        with_fields(offset, length, [this](RecordReader fields) { index_.add_channel(fields); });
        break;
      case Opcode::Metadata:
        with_fields(offset, length, [this](RecordReader fields) { index_.add_metadata(fields); });
        break;
      case Opcode::Message:
        add_message(offset, length);
        break;
      case Opcode::Chunk:
        add_chunk(offset, length);
        break;
      case Opcode::MessageIndex:
        add_message_index(offset, length);
        break;
      case Opcode::Attachment:
        add_attachment(offset, length);
        break;
      case Opcode::DataEnd:
      case Opcode::Footer:
        ended_ = true;
        break;
      default:
        break;
    }
  }

  template <class Visit>
  void with_fields(std::uint64_t offset, std::uint64_t length, const Visit& visit) {
    if (length > kMostKept) {
      throw MalformedRecord("it has " + std::to_string(length) + " bytes");
    }
    const Bytes fields = file_.read(offset + kRecordHeader, length);
    visit(RecordReader(fields));
  }

  void add_message(std::uint64_t offset, std::uint64_t length) {
    RecordReader fields(window_.at(offset + kRecordHeader, kMessageFields));
    const Message message = read_message(fields);
    const std::uint64_t size = kRecordHeader + length;
    ++index_.message_counts[message.channel];
    const bool goes_on = !index_.chunks.empty() && !index_.chunks.back().is_chunk &&
                         index_.chunks.back().offset + index_.chunks.back().length == offset &&
                         index_.chunks.back().length + size <= kLongestRun;
    if (!goes_on) {
      index_.chunks.push_back(
          {false, message.log_time, message.log_time, offset, 0, {message.channel}});
    }
    ChunkPlace& run = index_.chunks.back();
    run.start = std::min(run.start, message.log_time);
    run.end = std::max(run.end, message.log_time);
    run.length += size;
    run.channels.insert(message.channel);
  }

  void add_chunk(std::uint64_t offset, std::uint64_t length) {
    RecordReader fields(
        window_.at(offset + kRecordHeader, std::min<std::uint64_t>(length, kHeadOfRecord)));
    const ChunkHead head(fields);
    chunk_ = {true, head.start, head.end, offset, kRecordHeader + length, {}};
    chunk_counts_.clear();
  }

  void add_message_index(std::uint64_t offset, std::uint64_t length) {
    if (!chunk_) return;
    RecordReader fields(
        window_.at(offset + kRecordHeader, std::min<std::uint64_t>(length, kHeadOfRecord)));
    const auto channel = fields.number<std::uint16_t>();
    constexpr std::uint64_t kEntry = 8 + 8;
    chunk_counts_[channel] += fields.number<std::uint32_t>() / kEntry;
  }

  /// A chunk whose index has been read as far as it is there. The chunk itself is asked where its
  /// index may not be whole, or names a channel that it may declare.
  void settle_chunk(bool cut) {
    if (!chunk_) return;
    const bool known = std::ranges::all_of(
        chunk_counts_, [this](const auto& each) { return index_.channels.contains(each.first); });
    try {
      if (cut || chunk_counts_.empty() || !known) read_into_index();
      for (const auto& [channel, count] : chunk_counts_) {
        chunk_->channels.insert(channel);
        index_.message_counts[channel] += count;
      }
      index_.chunks.push_back(std::move(*chunk_));
    } catch (const MalformedRecord& malformed) {
      index_.add_problem("the chunk at byte " + std::to_string(chunk_->offset) +
                         " is passed over: " + malformed.what());
    }
    chunk_.reset();
  }

  void read_into_index() {
    chunk_counts_.clear();
    allowance_.check(read_);
    const Bytes records = read_chunk(file_, *chunk_, allowance_.memory);
    read_ += records.size();
    RecordReader reader(records);
    while (const auto record = next_record(reader)) {
      const RecordReader fields(record->fields);
      switch (static_cast<Opcode>(record->opcode)) {
        case Opcode::Schema:
          index_.add_schema(fields);
          break;
        case Opcode::Channel:
          index_.add_channel(fields);
          break;
        case Opcode::Message:
          ++chunk_counts_[read_message(fields).channel];
          break;
        default:
          break;
      }
    }
  }

  void add_attachment(std::uint64_t offset, std::uint64_t length) {
    RecordReader fields(
        window_.at(offset + kRecordHeader, std::min<std::uint64_t>(length, kHeadOfRecord)));
    fields.bytes(8 + 8);
    index_.attachments.push_back({fields.text(), offset, kRecordHeader + length});
  }

  const InputFile& file_;
  const Allowance allowance_;
  std::uint64_t read_ = 0;  // from chunks
  InputWindow window_;
  FileIndex index_;
  bool ended_ = false;
  std::optional<ChunkPlace> chunk_;  // the last one, while its index is read
  std::map<std::uint16_t, std::uint64_t> chunk_counts_;
};

}  // namespace

FileIndex scan(const InputFile& file, std::size_t memory) { return Scan(file, memory).run(); }

}  // namespace skein::recording
