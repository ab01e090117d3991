#include "local_readers.hpp"

#include "fast_reader.hpp"

namespace skein::dds::fastdds {

void LocalReaders::remove(FastReader& reader) {
  readers_.erase(&reader);
  guard_.reader_gone(rtps_message::entity_of(reader.guid()));
}

void LocalReaders::drop_incomplete(std::chrono::steady_clock::time_point now) {
  for (const auto& sample : guard_.give_up(now)) {
    Guid writer = sample.participant;
    rtps_message::put32(writer.bytes.data() + rtps_message::kPrefixSize, sample.writer, false);
    {
      std::lock_guard lock(mutex_);
      for (FastReader* const reader : readers_) reader->drop_incomplete(writer, sample.number);
    }
    guard_.dropped(sample);
  }
}

}  // namespace skein::dds::fastdds
