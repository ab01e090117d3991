#pragma once

#include "dds/port/receive_queue.hpp"
#include "fast_participant.hpp"
#include "received_payloads.hpp"

namespace skein::dds::fastdds {

/// A reader on Fast DDS's RTPS layer. Samples leave Fast DDS's history as they come, so that take()
/// needs none of its locks: they are held while on_data runs.
class FastReader final : public Reader, private FastReaderListener {
 public:
  FastReader(FastParticipant& participant, const Topic& topic, const Qos& qos,
             dds::ReaderListener listener);
  ~FastReader() override;

  std::size_t take(const std::function<void(const Sample&)>& consumer, std::size_t limit) override {
    return queue_.take(consumer, limit);
  }
  Guid guid() const override { return guid_; }
  std::vector<Guid> matched_writers() const override { return events_->peers(); }
  ReceiveCounters counters() const override { return queue_.counters(); }

  /// Drops what has come of a writer's sample, unless all has: it may come anew.
  void drop_incomplete(const Guid& writer, std::int64_t number);

 private:
  void on_matched(const Guid& writer, bool now) override;
  void on_received(const rtps::CacheChange_t& change) override;
  void on_writer(const Guid& writer, const AnnouncedWriter* found) override;

  EndpointListener endpoint_listener(dds::ReaderListener& listener);
  bool store(const rtps::CacheChange_t& change);
  Payload take_over(const rtps::CacheChange_t& change);
  std::optional<KeyHash> key_of(const rtps::CacheChange_t& change) const;

  FastParticipant& participant_;
  const Topic topic_;
  const TopicUse<FastParticipant> use_;
  const std::function<void(Reader&)> on_data_;
  const std::shared_ptr<EndpointEvents> events_;
  std::optional<EndpointWatch> peers_;
  const std::shared_ptr<ReceivedPayloads> payloads_ = std::make_shared<ReceivedPayloads>();
  rtps::ReaderHistory history_;
  ReceiveQueue queue_;
  rtps::RTPSReader* reader_ = nullptr;
  Guid guid_;
};

}  // namespace skein::dds::fastdds
