#include "recording/mcap/writer.hpp"

#include <pthread.h>

#include <atomic>
#include <deque>
#include <filesystem>
#include <mutex>
#include <numeric>
#include <thread>

#include "core/log.hpp"
#include "core/system/whole_file.hpp"
#include "core/threads/start_thread.hpp"
#include "recording/mcap/chunk_queue.hpp"
#include "recording/mcap/drop_report.hpp"
#include "recording/mcap/recording_file.hpp"
#include "skein/error.hpp"

namespace skein::recording {
namespace {

constexpr std::size_t kMostIds = 65535;

void check(const WriterOptions& options) {
  const auto refuse_zero = [](auto value, const char* name) {
    if (value == decltype(value){}) {
      throw InvalidArgument(std::string("a recording's ") + name + " is 0; take more");
    }
  };
  refuse_zero(options.chunk_size, "chunk_size");
  refuse_zero(options.queue_size, "queue_size");
  if (options.chunk_age.count() < 0 || options.split_duration.count() < 0) {
    throw InvalidArgument("a recording's chunk_age or split_duration is negative");
  }
}

std::uint64_t sum(const std::vector<ChannelStatistics>& channels,
                  std::uint64_t ChannelStatistics::*member) {
  return std::accumulate(
      channels.begin(), channels.end(), std::uint64_t{0},
      [&](std::uint64_t all, const ChannelStatistics& channel) { return all + channel.*member; });
}

}  // namespace

std::uint64_t WriterStatistics::written() const {
  return sum(channels, &ChannelStatistics::written);
}

std::uint64_t WriterStatistics::dropped() const {
  return sum(channels, &ChannelStatistics::dropped);
}

struct Writer::State {
  State(const std::string& its_path, const WriterOptions& its_options)
      : path(its_path),
        options(its_options),
        queue({options.chunk_size, options.chunk_age, options.queue_size, options.wait_for_room}) {
    begin_file();
    thread = start_thread("skein-record", [this] { run(); });
    pthread_setname_np(thread.native_handle(), "skein-record");
  }

  void check_channel(std::uint16_t channel) const {
    if (channel != 0 && channel <= channel_count) return;
    throw InvalidArgument("a message has the channel " + std::to_string(channel) +
                          ", which was not added before");
  }

  // ---- the thread

  void run() {
    for (;;) {
      std::optional<Chunk> chunk = queue.take();
      if (!chunk && queue.is_drained()) break;
      if (chunk) {
        const bool well = attempt([&] { write(*chunk); });
        count(*chunk, well ? &ChannelStatistics::written : &ChannelStatistics::dropped);
        queue.give_back(std::move(*chunk));
      }
      attempt([this] {
        write_extras();
        report(false);
      });
    }
    attempt([this] { end_file(); });
  }

  template <class Action>
  bool attempt(Action&& action) {
    if (!file) return false;
    try {
      action();
      return true;
    } catch (const std::exception& error) {
      fail(error.what());
      return false;
    }
  }

  /// Nothing more is written. The index may still have room: a chunk that had none is gone again.
  void fail(const std::string& why) {
    log(LogLevel::Error, "recording", why);
    queue.close();
    {
      const std::lock_guard lock(mutex);
      figures.failure = why;
    }
    try {
      if (file) file->finish();
    } catch (const std::exception&) {  // said already
    }
    file.reset();
  }

  void write(const Chunk& chunk) {
    if (is_full(chunk)) {
      end_file();
      begin_file();
    }
    for (const std::uint16_t id : chunk.channels()) {
      if (!file->has_channel(id)) define(id);
    }
    file->write(chunk);
  }

  bool is_full(const Chunk& chunk) const {
    const auto start = file->start();
    if (!start) return false;
    const auto duration = static_cast<std::uint64_t>(options.split_duration.count());
    return (options.split_size > 0 && file->size() + chunk.records().size() > options.split_size) ||
           (duration > 0 && chunk.end() > *start && chunk.end() - *start >= duration);
  }

  void define(std::uint16_t id) {
    std::unique_lock lock(mutex);
    const Channel& channel = channels[id - 1U];  // stays where it is
    const Schema* schema = channel.schema == 0 ? nullptr : &schemas[channel.schema - 1U];
    lock.unlock();
    if (schema && !file->has_schema(schema->id)) file->write(*schema);
    file->write(channel);
  }

  void write_extras() {
    std::unique_lock lock(mutex);
    while (attachments_written < attachments.size()) {
      const Attachment& attachment = attachments[attachments_written++];
      lock.unlock();
      file->write(attachment);
      lock.lock();
    }
    while (metadata_written < metadata.size()) {
      const Metadata& values = metadata[metadata_written++];
      lock.unlock();
      file->write(values);
      lock.lock();
    }
    figures.bytes = finished_bytes + file->size();
  }

  void report(bool last) {
    std::unique_lock lock(mutex);
    if (sum(figures.channels, &ChannelStatistics::dropped) == 0) return;
    const auto counted = figures.channels;
    lock.unlock();
    if (const auto said = drop_report.make(counted, last)) file->write(*said);
  }

  void count(const Chunk& chunk, std::uint64_t ChannelStatistics::*member) {
    const std::lock_guard lock(mutex);
    for (const std::uint16_t id : chunk.channels()) {
      figures.channels[id - 1U].*member += chunk.index(id).size();
    }
  }

  void begin_file() {
    std::string name = path;
    if (options.split_size > 0 || options.split_duration.count() > 0) {
      const std::filesystem::path whole(path);
      const std::string number = "_" + std::to_string(figures.files.size());
      name = whole.parent_path() / (whole.stem().string() + number + whole.extension().string());
    }
    file.emplace(name, options.library, options.compression_level);
    attachments_written = 0;
    metadata_written = 0;
    drop_report.begin_file();
    const std::lock_guard lock(mutex);
    figures.files.push_back(std::move(name));
  }

  void end_file() {
    write_extras();
    report(true);
    file->finish();
    finished_bytes += file->size();
    file.reset();
    const std::lock_guard lock(mutex);
    figures.bytes = finished_bytes;
  }

  const std::string path;
  const WriterOptions options;
  ChunkQueue queue;

  mutable std::mutex mutex;
  // Grow at their end alone, and nothing in them changes.
  std::deque<Schema> schemas;
  std::deque<Channel> channels;
  std::deque<Attachment> attachments;
  std::deque<Metadata> metadata;
  WriterStatistics figures;
  std::atomic<std::uint16_t> channel_count = 0;

  // The thread's.
  std::optional<RecordingFile> file;
  std::size_t attachments_written = 0;
  std::size_t metadata_written = 0;
  std::uint64_t finished_bytes = 0;
  DropReport drop_report;

  std::once_flag joined;
  std::thread thread;
};

Writer::Writer(const std::string& path, const WriterOptions& options) {
  check(options);
  state_ = std::make_unique<State>(path, options);
}

Writer::~Writer() {
  try {
    close();
  } catch (const Unavailable&) {  // logged when it happened
  }
}

std::uint16_t Writer::add_schema(std::string name, std::string encoding, std::string data) {
  const std::lock_guard lock(state_->mutex);
  auto& schemas = state_->schemas;
  if (schemas.size() == kMostIds) {
    throw InvalidArgument("the schema '" + name + "' is one too many: a recording has 65535");
  }
  const auto id = static_cast<std::uint16_t>(schemas.size() + 1);
  schemas.push_back({id, std::move(name), std::move(encoding), std::move(data)});
  return id;
}

std::uint16_t Writer::add_channel(std::string topic, std::uint16_t schema,
                                  std::map<std::string, std::string> metadata,
                                  std::string message_encoding) {
  const std::lock_guard lock(state_->mutex);
  auto& channels = state_->channels;
  if (channels.size() == kMostIds) {
    throw InvalidArgument("the topic '" + topic + "' is one too many: a recording has 65535");
  }
  if (schema > state_->schemas.size()) {
    throw InvalidArgument("the topic '" + topic + "' has the schema " + std::to_string(schema) +
                          ", which was not added before");
  }
  const auto id = static_cast<std::uint16_t>(channels.size() + 1);
  state_->figures.channels.push_back({topic, 0, 0});
  channels.push_back(
      {id, schema, std::move(topic), std::move(message_encoding), std::move(metadata)});
  state_->channel_count = id;
  return id;
}

bool Writer::write(const Message& message) {
  state_->check_channel(message.channel);
  if (state_->queue.add(message)) return true;
  count_dropped(message.channel, 1);
  return false;
}

void Writer::count_dropped(std::uint16_t channel, std::uint64_t messages) {
  state_->check_channel(channel);
  const std::lock_guard lock(state_->mutex);
  state_->figures.channels[channel - 1U].dropped += messages;
}

void Writer::attach(Attachment attachment) {
  {
    const std::lock_guard lock(state_->mutex);
    state_->attachments.push_back(std::move(attachment));
  }
  state_->queue.wake();
}

void Writer::add_metadata(Metadata metadata) {
  {
    const std::lock_guard lock(state_->mutex);
    state_->metadata.push_back(std::move(metadata));
  }
  state_->queue.wake();
}

WriterStatistics Writer::statistics() const {
  const std::lock_guard lock(state_->mutex);
  return state_->figures;
}

void Writer::close() {
  state_->queue.close();
  std::call_once(state_->joined, [this] { state_->thread.join(); });
  const std::string failure = statistics().failure;
  if (!failure.empty()) throw WriteFailed(failure);
}

}  // namespace skein::recording
