#pragma once

// Fast DDS 3, under the names that fast_dds_2.hpp explains.

#include <chrono>
#include <fastdds/dds/core/Time_t.hpp>
#include <fastdds/dds/publisher/qos/WriterQos.hpp>
#include <fastdds/dds/subscriber/qos/ReaderQos.hpp>
#include <fastdds/rtps/RTPSDomain.hpp>
#include <fastdds/rtps/attributes/HistoryAttributes.hpp>
#include <fastdds/rtps/attributes/RTPSParticipantAttributes.hpp>
#include <fastdds/rtps/attributes/ReaderAttributes.hpp>
#include <fastdds/rtps/attributes/WriterAttributes.hpp>
#include <fastdds/rtps/builtin/data/PublicationBuiltinTopicData.hpp>
#include <fastdds/rtps/builtin/data/SubscriptionBuiltinTopicData.hpp>
#include <fastdds/rtps/common/CacheChange.hpp>
#include <fastdds/rtps/history/IPayloadPool.hpp>
#include <fastdds/rtps/history/ReaderHistory.hpp>
#include <fastdds/rtps/history/WriterHistory.hpp>
#include <fastdds/rtps/participant/RTPSParticipant.hpp>
#include <fastdds/rtps/participant/RTPSParticipantListener.hpp>
#include <fastdds/rtps/reader/RTPSReader.hpp>
#include <fastdds/rtps/reader/ReaderListener.hpp>
#include <fastdds/rtps/transport/ChainingTransport.hpp>
#include <fastdds/rtps/transport/ChainingTransportDescriptor.hpp>
#include <fastdds/rtps/transport/SenderResource.hpp>
#include <fastdds/rtps/transport/TransportInterface.hpp>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.hpp>
#include <fastdds/rtps/transport/shared_mem/SharedMemTransportDescriptor.hpp>
#include <fastdds/rtps/writer/RTPSWriter.hpp>
#include <fastdds/rtps/writer/WriterListener.hpp>
#include <fastdds/utils/IPLocator.hpp>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "dds/fastdds/fast_identity.hpp"
#include "dds/rtps/rtps_message.hpp"
#include "skein/detail/qos.hpp"

namespace skein::dds::fastdds {

namespace rtps = eprosima::fastdds::rtps;
namespace policies = eprosima::fastdds::dds;
namespace transports = eprosima::fastdds::rtps;

using eprosima::fastdds::RecursiveTimedMutex;
using policies::Duration_t;
using policies::ReaderQos;
using policies::WriterQos;
inline const Duration_t kInfinite = policies::c_TimeInfinite;

inline constexpr auto kHeartbeatPeriod = &rtps::WriterTimes::heartbeat_period;
inline constexpr auto kInitialHeartbeatDelay = &rtps::WriterTimes::initial_heartbeat_delay;
inline constexpr auto kNackResponseDelay = &rtps::WriterTimes::nack_response_delay;
inline constexpr auto kNackSuppression = &rtps::WriterTimes::nack_supression_duration;
inline constexpr auto kInitialAckNackDelay = &rtps::ReaderTimes::initial_acknack_delay;
inline constexpr auto kHeartbeatResponseDelay = &rtps::ReaderTimes::heartbeat_response_delay;

inline constexpr bool kForgettingMayHang = false;
inline constexpr bool kAnnouncesRepresentation = true;

using AnnouncedWriter = rtps::PublicationBuiltinTopicData;
using AnnouncedReader = rtps::SubscriptionBuiltinTopicData;

struct AnnouncedEndpoint {
  template <class Data>
  explicit AnnouncedEndpoint(const Data& data)
      : topic(data.topic_name.to_string()),
        type(data.type_name.to_string()),
        reliability(data.reliability),
        durability(data.durability),
        deadline(data.deadline),
        liveliness(data.liveliness),
        ownership(data.ownership),
        representation(data.representation),
        user_data(data.user_data),
        partition(data.partition) {}

  std::string topic;
  std::string type;
  const policies::ReliabilityQosPolicy& reliability;
  const policies::DurabilityQosPolicy& durability;
  const policies::DeadlineQosPolicy& deadline;
  const policies::LivelinessQosPolicy& liveliness;
  const policies::OwnershipQosPolicy& ownership;
  const policies::DataRepresentationQosPolicy& representation;
  const policies::UserDataQosPolicy& user_data;
  const policies::PartitionQosPolicy& partition;
};

inline std::uint32_t strength_of(const AnnouncedWriter& writer) {
  return writer.ownership_strength.value;
}
inline const Duration_t& lifespan_of(const AnnouncedWriter& writer) {
  return writer.lifespan.duration;
}

class ParticipantListener : public rtps::RTPSParticipantListener {
 protected:
  enum class Change { Found, Changed, Gone };
  struct Announced {
    Guid guid;
    std::string name;
    const rtps::RemoteLocatorList& locators;
    const Duration_t& lease;
  };
  virtual void on_participant(Change change, const Announced& participant) = 0;
  virtual void on_writer(const Guid& writer, const AnnouncedWriter* found) = 0;
  virtual void on_reader(const Guid& reader, const AnnouncedReader* found) = 0;

 private:
  void on_participant_discovery(rtps::RTPSParticipant*, rtps::ParticipantDiscoveryStatus status,
                                const rtps::ParticipantBuiltinTopicData& info, bool&) final {
    using Status = rtps::ParticipantDiscoveryStatus;
    const Change change = status == Status::DISCOVERED_PARTICIPANT    ? Change::Found
                          : status == Status::CHANGED_QOS_PARTICIPANT ? Change::Changed
                                                                      : Change::Gone;
    on_participant(change, {to_guid(info.guid), info.participant_name.to_string(),
                            info.metatraffic_locators, info.lease_duration});
  }
  void on_writer_discovery(rtps::RTPSParticipant*, rtps::WriterDiscoveryStatus status,
                           const AnnouncedWriter& info, bool&) final {
    const bool gone = status == rtps::WriterDiscoveryStatus::REMOVED_WRITER;
    on_writer(to_guid(info.guid), gone ? nullptr : &info);
  }
  void on_reader_discovery(rtps::RTPSParticipant*, rtps::ReaderDiscoveryStatus status,
                           const AnnouncedReader& info, bool&) final {
    const bool gone = status == rtps::ReaderDiscoveryStatus::REMOVED_READER;
    on_reader(to_guid(info.guid), gone ? nullptr : &info);
  }
};

class FastReaderListener : public rtps::ReaderListener {
 protected:
  virtual void on_matched(const Guid& writer, bool now) = 0;
  virtual void on_received(const rtps::CacheChange_t& change) = 0;
  virtual void on_writer(const Guid& writer, const AnnouncedWriter* found) = 0;

 private:
  void on_reader_matched(rtps::RTPSReader*, const rtps::MatchingInfo& info) final {
    on_matched(to_guid(info.remoteEndpointGuid), info.status == rtps::MATCHED_MATCHING);
  }
  void on_new_cache_change_added(rtps::RTPSReader*, const rtps::CacheChange_t* const change) final {
    on_received(*change);
  }
  void on_writer_discovery(rtps::RTPSReader*, rtps::WriterDiscoveryStatus reason,
                           const rtps::GUID_t& writer, const AnnouncedWriter* info) final {
    const bool gone = reason == rtps::WriterDiscoveryStatus::REMOVED_WRITER;
    on_writer(to_guid(writer), gone ? nullptr : info);
  }
};

class FastWriterListener : public rtps::WriterListener {
 protected:
  virtual void on_matched(const Guid& reader, bool now) = 0;
  virtual void on_acknowledged_by_all(rtps::CacheChange_t& change) = 0;
  virtual void on_reader(const Guid& reader, const AnnouncedReader* found) = 0;

 private:
  void on_writer_matched(rtps::RTPSWriter*, const rtps::MatchingInfo& info) final {
    on_matched(to_guid(info.remoteEndpointGuid), info.status == rtps::MATCHED_MATCHING);
  }
  void on_writer_change_received_by_all(rtps::RTPSWriter*, rtps::CacheChange_t* change) final {
    on_acknowledged_by_all(*change);
  }
  void on_reader_discovery(rtps::RTPSWriter*, rtps::ReaderDiscoveryStatus reason,
                           const rtps::GUID_t& reader, const AnnouncedReader* info) final {
    const bool gone = reason == rtps::ReaderDiscoveryStatus::REMOVED_READER;
    on_reader(to_guid(reader), gone ? nullptr : info);
  }
};

/// The memory of a writer's samples. Fast DDS holds a sample while it sends it, a fragment at a
/// time: that of its own histories is copied for each fragment, whole.
std::shared_ptr<rtps::IPayloadPool> make_held_payloads();

class SentSamples : public rtps::WriterHistory {
 public:
  explicit SentSamples(const rtps::HistoryAttributes& attributes)
      : WriterHistory(attributes, make_held_payloads()) {}
};

class PayloadPool : public rtps::IPayloadPool {
 public:
  virtual void reserve(std::uint32_t size, rtps::CacheChange_t& change) = 0;
  virtual bool copy(const rtps::SerializedPayload_t& data, rtps::CacheChange_t& change) = 0;
  virtual void release(rtps::SerializedPayload_t& payload) = 0;

 private:
  bool get_payload(std::uint32_t size, rtps::SerializedPayload_t& payload) final {
    reserve(size, change_of(payload));
    payload.payload_owner = this;
    return true;
  }
  /// Is called a second time to share with others what has just been copied: they copy it, too.
  bool get_payload(const rtps::SerializedPayload_t& data,
                   rtps::SerializedPayload_t& payload) final {
    if (data.payload_owner == this || !copy(data, change_of(payload))) return false;
    payload.payload_owner = this;
    return true;
  }
  bool release_payload(rtps::SerializedPayload_t& payload) final {
    release(payload);
    payload.payload_owner = nullptr;
    return true;
  }

  /// Fast DDS 3 names the payload alone; a reader's is always that of a change.
  static rtps::CacheChange_t& change_of(rtps::SerializedPayload_t& payload) {
    static const rtps::CacheChange_t any;
    static const auto distance =
        reinterpret_cast<const char*>(&any.serializedPayload) - reinterpret_cast<const char*>(&any);
    return *reinterpret_cast<rtps::CacheChange_t*>(reinterpret_cast<char*>(&payload) - distance);
  }
};

/// Samples that a message carries lie in buffers of their own.
class TransportBefore : public transports::ChainingTransport {
 public:
  using ChainingTransport::ChainingTransport;

 protected:
  class Outgoing {
   public:
    Outgoing(rtps::SenderResource& sender, const std::vector<rtps::NetworkBuffer>& buffers,
             std::uint32_t size, const std::chrono::steady_clock::time_point& limit)
        : sender_(sender), buffers_(buffers), size_(size), limit_(limit) {}

    const void* sender() const { return &sender_; }
    bool send(rtps::LocatorsIterator* first, rtps::LocatorsIterator* last) {
      return sender_.send(buffers_, size_, first, last, limit_);
    }
    template <class Visit>
    void for_each_submessage(Visit&& visit) {
      rtps_message::for_each_submessage(buffers_, std::forward<Visit>(visit));
    }

   private:
    rtps::SenderResource& sender_;
    const std::vector<rtps::NetworkBuffer>& buffers_;
    std::uint32_t size_;
    const std::chrono::steady_clock::time_point& limit_;
  };
  virtual bool send_message(Outgoing message, rtps::LocatorsIterator* first,
                            rtps::LocatorsIterator* last) = 0;

 private:
  bool send(rtps::SenderResource* sender, const std::vector<rtps::NetworkBuffer>& buffers,
            std::uint32_t size, rtps::LocatorsIterator* first, rtps::LocatorsIterator* last,
            const std::chrono::steady_clock::time_point& limit) final {
    return send_message(Outgoing(*sender, buffers, size, limit), first, last);
  }
};

}  // namespace skein::dds::fastdds
