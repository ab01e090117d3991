#pragma once

#include <atomic>

#include "cyclone_participant.hpp"
#include "dds/port/receive_queue.hpp"
#include "history_cache.hpp"
#include "matches.hpp"

namespace skein::dds::cyclonedds {

class CycloneReader final : public Reader {
 public:
  CycloneReader(CycloneParticipant& participant, const Topic& topic, const Qos& qos,
                ReaderListener listener);
  ~CycloneReader() override;

  std::size_t take(const std::function<void(const Sample&)>& consumer, std::size_t limit) override {
    return queue_.take(consumer, limit);
  }
  Guid guid() const override { return guid_; }
  std::vector<Guid> matched_writers() const override { return matches_.current(); }
  ReceiveCounters counters() const override { return queue_.counters(); }

 private:
  Entity make(const Topic& topic, const Qos& qos);
  void data_available();
  void matched(const Guid& writer, bool now);
  void liveliness_changed(const dds_liveliness_changed_status_t& status);

  CycloneParticipant& participant_;
  const Topic topic_;
  const TopicUse<CycloneParticipant> use_;
  const ReaderListener listener_;
  std::optional<EndpointWatch> peers_;
  ReceiveQueue queue_;
  HistoryCache cache_;
  Matches matches_;
  std::atomic<bool> made_{false};
  std::mutex data_;                             // one on_data at a time
  std::atomic<dds_entity_t> reader_handle_{0};  // 0 for listeners that come before it is made
  Guid guid_;
  Entity reader_;  // goes first: its listeners use the rest
};

}  // namespace skein::dds::cyclonedds
