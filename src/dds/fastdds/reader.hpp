#pragma once

#include <fastdds/rtps/history/ReaderHistory.h>
#include <fastdds/rtps/reader/RTPSReader.h>
#include <fastdds/rtps/reader/ReaderListener.h>

#include <atomic>

#include "../deadline_watch.hpp"
#include "../keyed_queue.hpp"
#include "../sample_gate.hpp"
#include "participant.hpp"
#include "received_payloads.hpp"
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
  std::uint64_t expired() const override { return gate_.expired(); }
  std::uint64_t replaced() const override { return replaced_.load(std::memory_order_relaxed); }

 private:
  struct Item {
    Bytes cdr;
    InstanceState state;
    KeyHash key;
    Guid writer;
    SourceTime expiry = SampleGate::kNever;
  };

  void onReaderMatched(rtps::RTPSReader*, rtps::MatchingInfo&) override {}
  void onReaderMatched(rtps::RTPSReader* reader,
                       const eprosima::fastdds::dds::SubscriptionMatchedStatus& status) override;
  void onNewCacheChangeAdded(rtps::RTPSReader* reader,
                             const rtps::CacheChange_t* const change) override;

  void on_writer_discovery(rtps::RTPSReader* reader,
                           rtps::WriterDiscoveryInfo::DISCOVERY_STATUS reason,
                           const rtps::GUID_t& writer, const rtps::WriterProxyData* info) override;

  EndpointListener endpoint_listener(dds::ReaderListener& listener);
  std::unique_ptr<DeadlineTimer> deadline_timer(const Qos& qos, DeadlineTimer::Missed missed);
  bool admit(Item& item, SourceTime written);
  std::optional<KeyHash> key_of(const rtps::CacheChange_t& change,
                                std::span<const std::byte> received) const;
  bool store(const rtps::CacheChange_t& change);
  std::optional<Item> pop();

  FastParticipant& participant_;
  const Topic topic_;
  const std::function<void(Reader&)> on_data_;
  const decltype(dds::ReaderListener::find_key) find_key_;
  const bool tells_incompatible_;
  const std::shared_ptr<EndpointEvents> events_;
  const std::shared_ptr<ReceivedPayloads> payloads_ = std::make_shared<ReceivedPayloads>();
  rtps::ReaderHistory history_;
  std::mutex mutex_;
  KeyedQueue<Item> queue_;
  SampleGate gate_;
  const bool exclusive_;
  /// Of the matched writers whose samples expire or contend.
  std::unordered_map<Guid, SampleGate::Writer> writers_;
  std::atomic<std::uint64_t> malformed_{0};
  std::atomic<std::uint64_t> replaced_{0};
  rtps::RTPSReader* reader_ = nullptr;
  Guid guid_;
  std::unique_ptr<DeadlineTimer> deadline_;
};

}  // namespace skein::dds::fastdds
