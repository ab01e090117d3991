#pragma once

// Fast DDS 2, as the sources of this back end name it. release_3/fast_dds_3.hpp has the same names
// for release 3; CMake chooses.

#include <fastdds/rtps/RTPSDomain.h>
#include <fastdds/rtps/attributes/HistoryAttributes.h>
#include <fastdds/rtps/attributes/RTPSParticipantAttributes.h>
#include <fastdds/rtps/attributes/ReaderAttributes.h>
#include <fastdds/rtps/attributes/WriterAttributes.h>
#include <fastdds/rtps/builtin/data/ReaderProxyData.h>
#include <fastdds/rtps/builtin/data/WriterProxyData.h>
#include <fastdds/rtps/common/CacheChange.h>
#include <fastdds/rtps/history/IPayloadPool.h>
#include <fastdds/rtps/history/ReaderHistory.h>
#include <fastdds/rtps/history/WriterHistory.h>
#include <fastdds/rtps/participant/ParticipantDiscoveryInfo.h>
#include <fastdds/rtps/participant/RTPSParticipant.h>
#include <fastdds/rtps/participant/RTPSParticipantListener.h>
#include <fastdds/rtps/reader/RTPSReader.h>
#include <fastdds/rtps/reader/ReaderListener.h>
#include <fastdds/rtps/transport/ChainingTransport.h>
#include <fastdds/rtps/transport/ChainingTransportDescriptor.h>
#include <fastdds/rtps/transport/TransportInterface.h>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastdds/rtps/transport/shared_mem/SharedMemTransportDescriptor.h>
#include <fastdds/rtps/writer/RTPSWriter.h>
#include <fastdds/rtps/writer/WriterListener.h>
#include <fastrtps/qos/ReaderQos.h>
#include <fastrtps/qos/WriterQos.h>
#include <fastrtps/utils/IPLocator.h>

#include <chrono>
#include <string>
#include <utility>

#include "dds/fastdds/fast_identity.hpp"
#include "dds/rtps/rtps_message.hpp"
#include "skein/detail/qos.hpp"

namespace skein::dds::fastdds {

namespace rtps = eprosima::fastrtps::rtps;
namespace policies = eprosima::fastdds::dds;
namespace transports = eprosima::fastdds::rtps;

using eprosima::fastrtps::Duration_t;
using eprosima::fastrtps::ReaderQos;
using eprosima::fastrtps::RecursiveTimedMutex;
using eprosima::fastrtps::WriterQos;
inline const Duration_t kInfinite = eprosima::fastrtps::c_TimeInfinite;

inline constexpr auto kHeartbeatPeriod = &rtps::WriterTimes::heartbeatPeriod;
inline constexpr auto kInitialHeartbeatDelay = &rtps::WriterTimes::initialHeartbeatDelay;
inline constexpr auto kNackResponseDelay = &rtps::WriterTimes::nackResponseDelay;
inline constexpr auto kNackSuppression = &rtps::WriterTimes::nackSupressionDuration;
inline constexpr auto kInitialAckNackDelay = &rtps::ReaderTimes::initialAcknackDelay;
inline constexpr auto kHeartbeatResponseDelay = &rtps::ReaderTimes::heartbeatResponseDelay;

// What WORKAROUNDS.md tells of this release alone.
inline constexpr bool kForgettingMayHang = true;
inline constexpr bool kAnnouncesRepresentation = false;

// What others announce of their endpoints.
using AnnouncedWriter = rtps::WriterProxyData;
using AnnouncedReader = rtps::ReaderProxyData;

struct AnnouncedEndpoint {
  template <class Proxy>
  explicit AnnouncedEndpoint(const Proxy& proxy)
      : topic(proxy.topicName().to_string()),
        type(proxy.typeName().to_string()),
        reliability(proxy.m_qos.m_reliability),
        durability(proxy.m_qos.m_durability),
        deadline(proxy.m_qos.m_deadline),
        liveliness(proxy.m_qos.m_liveliness),
        ownership(proxy.m_qos.m_ownership),
        representation(proxy.m_qos.representation),
        user_data(proxy.m_qos.m_userData),
        partition(proxy.m_qos.m_partition) {}

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
  return writer.m_qos.m_ownershipStrength.value;
}
inline const Duration_t& lifespan_of(const AnnouncedWriter& writer) {
  return writer.m_qos.m_lifespan.duration;
}

/// Hears of other participants, and of their endpoints.
class ParticipantListener : public rtps::RTPSParticipantListener {
 protected:
  enum class Change { Found, Changed, Gone };
  struct Announced {
    Guid guid;
    std::string name;
    const rtps::RemoteLocatorList& locators;  // of discovery
    const Duration_t& lease;
  };
  virtual void on_participant(Change change, const Announced& participant) = 0;
  virtual void on_writer(const Guid& writer, const AnnouncedWriter* found) = 0;  // or gone
  virtual void on_reader(const Guid& reader, const AnnouncedReader* found) = 0;

 private:
  void onParticipantDiscovery(rtps::RTPSParticipant*, rtps::ParticipantDiscoveryInfo&& info) final {
    using Info = rtps::ParticipantDiscoveryInfo;
    const Change change = info.status == Info::DISCOVERED_PARTICIPANT    ? Change::Found
                          : info.status == Info::CHANGED_QOS_PARTICIPANT ? Change::Changed
                                                                         : Change::Gone;
    on_participant(change, {to_guid(info.info.m_guid), info.info.m_participantName.to_string(),
                            info.info.metatraffic_locators, info.info.m_leaseDuration});
  }
  void onWriterDiscovery(rtps::RTPSParticipant*, rtps::WriterDiscoveryInfo&& info) final {
    const bool gone = info.status == rtps::WriterDiscoveryInfo::REMOVED_WRITER;
    on_writer(to_guid(info.info.guid()), gone ? nullptr : &info.info);
  }
  void onReaderDiscovery(rtps::RTPSParticipant*, rtps::ReaderDiscoveryInfo&& info) final {
    const bool gone = info.status == rtps::ReaderDiscoveryInfo::REMOVED_READER;
    on_reader(to_guid(info.info.guid()), gone ? nullptr : &info.info);
  }
};

class FastReaderListener : public rtps::ReaderListener {
 protected:
  virtual void on_matched(const Guid& writer, bool now) = 0;
  virtual void on_received(const rtps::CacheChange_t& change) = 0;
  virtual void on_writer(const Guid& writer, const AnnouncedWriter* found) = 0;  // or gone

 private:
  void onReaderMatched(rtps::RTPSReader*, rtps::MatchingInfo&) final {}
  void onReaderMatched(rtps::RTPSReader*, const policies::SubscriptionMatchedStatus& status) final {
    on_matched(to_guid(status.last_publication_handle), status.current_count_change > 0);
  }
  void onNewCacheChangeAdded(rtps::RTPSReader*, const rtps::CacheChange_t* const change) final {
    on_received(*change);
  }
  void on_writer_discovery(rtps::RTPSReader*, rtps::WriterDiscoveryInfo::DISCOVERY_STATUS reason,
                           const rtps::GUID_t& writer, const AnnouncedWriter* info) final {
    const bool gone = reason == rtps::WriterDiscoveryInfo::REMOVED_WRITER;
    on_writer(to_guid(writer), gone ? nullptr : info);
  }
};

class FastWriterListener : public rtps::WriterListener {
 protected:
  virtual void on_matched(const Guid& reader, bool now) = 0;
  virtual void on_acknowledged_by_all(rtps::CacheChange_t& change) = 0;
  virtual void on_reader(const Guid& reader, const AnnouncedReader* found) = 0;  // or gone

 private:
  void onWriterMatched(rtps::RTPSWriter*, rtps::MatchingInfo&) final {}
  void onWriterMatched(rtps::RTPSWriter*, const policies::PublicationMatchedStatus& status) final {
    on_matched(to_guid(status.last_subscription_handle), status.current_count_change > 0);
  }
  void onWriterChangeReceivedByAll(rtps::RTPSWriter*, rtps::CacheChange_t* change) final {
    on_acknowledged_by_all(*change);
  }
  void on_reader_discovery(rtps::RTPSWriter*, rtps::ReaderDiscoveryInfo::DISCOVERY_STATUS reason,
                           const rtps::GUID_t& reader, const AnnouncedReader* info) final {
    const bool gone = reason == rtps::ReaderDiscoveryInfo::REMOVED_READER;
    on_reader(to_guid(reader), gone ? nullptr : info);
  }
};

using SentSamples = rtps::WriterHistory;

/// The memory of a reader's samples.
class PayloadPool : public rtps::IPayloadPool {
 public:
  /// Memory for the payload of a sample that comes in fragments.
  virtual void reserve(std::uint32_t size, rtps::CacheChange_t& change) = 0;
  /// A copy of `data` as the payload of `change`; false: it is not received now.
  virtual bool copy(const rtps::SerializedPayload_t& data, rtps::CacheChange_t& change) = 0;
  virtual void release(rtps::SerializedPayload_t& payload) = 0;

 private:
  bool get_payload(std::uint32_t size, rtps::CacheChange_t& change) final {
    reserve(size, change);
    change.payload_owner(this);
    return true;
  }
  bool get_payload(rtps::SerializedPayload_t& data, rtps::IPayloadPool*&,
                   rtps::CacheChange_t& change) final {
    if (!copy(data, change)) return false;
    change.payload_owner(this);
    return true;
  }
  bool release_payload(rtps::CacheChange_t& change) final {
    release(change.serializedPayload);
    change.payload_owner(nullptr);
    return true;
  }
};

/// A transport before another one. A message is sent in one piece.
class TransportBefore : public transports::ChainingTransport {
 public:
  using ChainingTransport::ChainingTransport;

 protected:
  class Outgoing {
   public:
    Outgoing(rtps::SenderResource& sender, const rtps::octet* message, std::uint32_t size,
             const std::chrono::steady_clock::time_point& limit)
        : sender_(sender), message_(message), size_(size), limit_(limit) {}

    const void* sender() const { return &sender_; }
    bool send(rtps::LocatorsIterator* first, rtps::LocatorsIterator* last) {
      return sender_.send(message_, size_, first, last, limit_);
    }
    template <class Visit>
    void for_each_submessage(Visit&& visit) {
      rtps_message::for_each_submessage(const_cast<rtps::octet*>(message_), size_,
                                        std::forward<Visit>(visit));
    }

   private:
    rtps::SenderResource& sender_;
    const rtps::octet* message_;
    std::uint32_t size_;
    const std::chrono::steady_clock::time_point& limit_;
  };
  virtual bool send_message(Outgoing message, rtps::LocatorsIterator* first,
                            rtps::LocatorsIterator* last) = 0;

 private:
  bool send(rtps::SenderResource* sender, const rtps::octet* message, std::uint32_t size,
            rtps::LocatorsIterator* first, rtps::LocatorsIterator* last,
            const std::chrono::steady_clock::time_point& limit) final {
    return send_message(Outgoing(*sender, message, size, limit), first, last);
  }
};

}  // namespace skein::dds::fastdds
