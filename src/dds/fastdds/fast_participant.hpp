#pragma once

#include <fastdds/rtps/participant/RTPSParticipantListener.h>

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>

#include "dds/port/endpoints.hpp"
#include "dds/port/port.hpp"
#include "dds/port/topic_table.hpp"
#include "dds/rtps/multicast_membership.hpp"
#include "events.hpp"
#include "fast_shared_memory.hpp"
#include "transport.hpp"

namespace eprosima::fastrtps::rtps {
class RTPSParticipant;
}

namespace skein::dds::fastdds {

namespace rtps = eprosima::fastrtps::rtps;

class FastReader;

/// A participant on Fast DDS's RTPS layer. The DDS layer above it would add copies and locks for
/// what this port does not have, and it is the one that reads files and environment: profiles,
/// discovery servers, statistics. Here nothing does.
class FastParticipant final : public Participant, private rtps::RTPSParticipantListener {
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

  /// To be held while a reader is created or removed: Fast DDS forgets a local reader without a
  /// lock.
  std::mutex& readers() noexcept { return readers_; }
  /// To be held while a writer is made known: each thread that does so borrows one of four
  /// descriptions of readers before it waits for the lock of discovery, whose holder may need one.
  std::mutex& writers() noexcept { return writers_; }
  /// With readers() held.
  void add(FastReader& reader) { all_readers_.insert(&reader); }
  void remove(FastReader& reader);

  /// Tells a reader of the liveliness of the writers that it is matched with, until it closes.
  void watch_liveliness(std::weak_ptr<EndpointEvents> reader, std::chrono::nanoseconds lease);
  /// Tells others, often enough for `lease`, that this participant's writers live.
  void assert_liveliness_for(std::chrono::nanoseconds lease);
  RtpsGuard& guard() noexcept { return transport_->state->guard; }
  FastLeaseWatch& signs() noexcept { return transport_->state->signs; }
  Endpoints& endpoints() noexcept { return endpoints_; }
  int acquire_topic(const Topic& topic);
  void release_topic(const std::string& name);

 private:
  FastParticipant(const ParticipantOptions& options, const SegmentsTurn& turn);

  void onParticipantDiscovery(rtps::RTPSParticipant* participant,
                              rtps::ParticipantDiscoveryInfo&& info) override;
  void onWriterDiscovery(rtps::RTPSParticipant* participant,
                         rtps::WriterDiscoveryInfo&& info) override;
  void onReaderDiscovery(rtps::RTPSParticipant* participant,
                         rtps::ReaderDiscoveryInfo&& info) override;
  void end();
  void follow(const Guid& participant, std::optional<std::chrono::nanoseconds> lease);
  void watch_each(std::chrono::nanoseconds lease);
  void tick();
  void assert_liveliness_if_due();
  void check_leases();
  void check_liveliness();
  void drop_incomplete();
  void found(const Guid& guid, Endpoint endpoint);
  void lost(const Guid& endpoint);
  void forget_all();

  struct Watched {
    std::weak_ptr<EndpointEvents> reader;
    std::chrono::nanoseconds lease;
  };

  const ParticipantOptions options_;
  const std::shared_ptr<StartupTransportDescriptor> transport_;
  TopicTable<int> topics_;
  Endpoints endpoints_;
  std::map<Guid, std::string> names_;  // of participants that are present, under mutex_
  std::mutex writers_;
  std::mutex readers_;
  std::set<FastReader*> all_readers_;  // under readers_
  std::mutex mutex_;
  std::set<Guid> present_;
  std::vector<Watched> watched_;
  /// How often leases are looked at; the shortest needed so far.
  std::chrono::nanoseconds watch_period_{std::chrono::seconds(1)};
  std::mutex asserting_;  // held while an assertion is sent
  std::optional<std::chrono::nanoseconds> assertion_period_;
  std::chrono::steady_clock::time_point last_assertion_;
  EventThread events_;
  rtps::RTPSParticipant* participant_ = nullptr;
  std::optional<MulticastMembership> membership_;
  Guid guid_;
};

}  // namespace skein::dds::fastdds
