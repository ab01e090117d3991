#pragma once

#include <fastdds/rtps/history/ReaderHistory.h>
#include <fastdds/rtps/reader/RTPSReader.h>
#include <fastdds/rtps/reader/ReaderListener.h>

#include <atomic>

#include "../keyed_queue.hpp"
#include "participant.hpp"
#include "skein/core/bytes.hpp"

namespace skein::dds::fastdds {

/// A reader on Fast DDS's RTPS layer. Samples leave Fast DDS's history as they come, so that take()
/// needs none of its locks: they are held while on_data runs.
class FastReader final : public Reader, private rtps::ReaderListener {
 public:
  FastReader(FastParticipant& participant, const Topic& topic, const Qos& qos,
             dds::ReaderListener listener);
  ~FastReader() override;

  std::size_t take(const std::function<void(const Sample&)>& consumer, std::size_t limit) override;
  Guid guid() const override { return guid_; }
  std::vector<Guid> matched_writers() const override { return events_->peers(); }
  std::uint64_t malformed() const override { return malformed_.load(std::memory_order_relaxed); }

 private:
  struct Item {
    Bytes cdr;
    InstanceState state;
    KeyHash key;
    Guid writer;
  };

  void onReaderMatched(rtps::RTPSReader*, rtps::MatchingInfo&) override {}
  void onReaderMatched(rtps::RTPSReader* reader,
                       const eprosima::fastdds::dds::SubscriptionMatchedStatus& status) override;
  void onNewCacheChangeAdded(rtps::RTPSReader* reader,
                             const rtps::CacheChange_t* const change) override;

  bool store(const rtps::CacheChange_t& change);
  std::optional<Item> pop();
  Bytes spare_buffer();
  void give_back(Bytes buffer);

  FastParticipant& participant_;
  const Topic topic_;
  const std::function<void(Reader&)> on_data_;
  const std::shared_ptr<EndpointEvents> events_;
  const bool watches_liveliness_;
  rtps::ReaderHistory history_;
  std::mutex mutex_;
  KeyedQueue<Item> queue_;
  std::vector<Bytes> spares_;
  std::atomic<std::uint64_t> malformed_{0};
  rtps::RTPSReader* reader_ = nullptr;
  Guid guid_;
};

}  // namespace skein::dds::fastdds
