#pragma once

#include <atomic>

#include "cyclone_participant.hpp"
#include "dds/port/deadline_watch.hpp"
#include "matches.hpp"

namespace skein::dds::cyclonedds {

class CycloneWriter final : public Writer {
 public:
  CycloneWriter(CycloneParticipant& participant, const Topic& topic, const Qos& qos,
                WriterListener listener);
  ~CycloneWriter() override;

  void write(std::span<const std::byte> cdr, const KeyHash& key) override;
  void dispose(const KeyHash& key) override;
  bool wait_for_acknowledgments(std::chrono::milliseconds timeout) override;
  Guid guid() const override { return guid_; }
  std::vector<Guid> matched_readers() const override { return matches_.current(); }

 private:
  Entity make();
  void wait_for_room();
  void check_written(dds_return_t code);

  CycloneParticipant& participant_;
  const Topic topic_;
  const Qos qos_;
  const TopicUse<CycloneParticipant> use_;
  Matches matches_;
  std::optional<EndpointWatch> peers_;
  const std::unique_ptr<DeadlineTimer> deadline_;
  std::atomic<std::uint64_t> written_{0};       // so many may wait for acknowledgment, at most
  std::atomic<dds_entity_t> writer_handle_{0};  // 0 for listeners that come before it is made
  Guid guid_;
  Entity writer_;  // goes first: its listeners use the rest
};

}  // namespace skein::dds::cyclonedds
