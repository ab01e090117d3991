#pragma once

#include <memory>
#include <mutex>
#include <optional>

#include "dds/port/endpoints.hpp"
#include "dds/port/port.hpp"
#include "dds/port/topic_table.hpp"
#include "dds/rtps/multicast_membership.hpp"
#include "events.hpp"
#include "fast_discovery.hpp"
#include "fast_shared_memory.hpp"
#include "fast_silence.hpp"
#include "liveliness_assertions.hpp"
#include "local_readers.hpp"
#include "transport.hpp"

namespace skein::dds::fastdds {

/// A participant on Fast DDS's RTPS layer. The DDS layer above it would add copies and locks for
/// what this port does not have, and it is the one that reads files and environment: profiles,
/// discovery servers, statistics. Here nothing does.
class FastParticipant final : public Participant {
 public:
  explicit FastParticipant(const ParticipantOptions& options);
  ~FastParticipant() override;

  std::unique_ptr<Writer> create_writer(const Topic& topic, const Qos& qos,
                                        WriterListener listener) override;
  std::unique_ptr<Reader> create_reader(const Topic& topic, const Qos& qos,
                                        ReaderListener listener) override;
  Guid guid() const override { return guid_; }

  rtps::RTPSParticipant* rtps_participant() const noexcept { return participant_; }
  EventThread& events() noexcept { return events_; }

  LocalReaders& readers() noexcept { return readers_; }
  /// To be held while a writer is made known: each thread that does so borrows one of four
  /// descriptions of readers before it waits for the lock of discovery, whose holder may need one.
  std::mutex& writers() noexcept { return writers_; }

  FastSilence& silence() noexcept { return silence_; }
  /// Tells others, often enough for `lease`, that this participant's writers live.
  void assert_liveliness_for(std::chrono::nanoseconds lease);
  StartupTransportDescriptor::State& transport() noexcept { return *transport_->state; }
  Endpoints& endpoints() noexcept { return discovery_.endpoints(); }
  int acquire_topic(const Topic& topic);
  void release_topic(const std::string& name);

 private:
  FastParticipant(const ParticipantOptions& options, const SegmentsTurn& turn);

  void end();
  void tick();

  const ParticipantOptions options_;
  const std::shared_ptr<StartupTransportDescriptor> transport_;
  TopicTable<int> topics_;
  std::mutex writers_;
  LocalReaders readers_;
  LivelinessAssertions assertions_;
  FastSilence silence_;
  FastDiscovery discovery_;
  EventThread events_;
  rtps::RTPSParticipant* participant_ = nullptr;
  std::optional<MulticastMembership> membership_;
  Guid guid_;
};

}  // namespace skein::dds::fastdds
