#include "raw/fastdds_participant.hpp"

#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastdds/rtps/transport/shared_mem/SharedMemTransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>

#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>

#include "raw/message.hpp"

namespace skein::benchmarks::raw {
namespace {

namespace rtps = eprosima::fastrtps::rtps;
using eprosima::fastrtps::Duration_t;

/// What data sharing reserves for each sample, and how many samples it reserves.
constexpr std::uint32_t kGreatestMessage = (1 << 20) + 64;
constexpr std::int32_t kSharedSamples = 8;

class MessageType final : public dds::TopicDataType {
 public:
  explicit MessageType(Way way) : bounded_(way == Way::DataSharing) {
    setName(kType);
    m_typeSize = bounded_ ? kGreatestMessage : 512;
    auto_fill_type_object(false);
    auto_fill_type_information(false);
  }
  bool serialize(void* data, rtps::SerializedPayload_t* payload) override {
    const auto& message = *static_cast<const Outgoing*>(data);
    encode(message, reinterpret_cast<char*>(payload->data));
    payload->length = static_cast<std::uint32_t>(encoded_size(message));
    return true;
  }
  bool deserialize(rtps::SerializedPayload_t* payload, void* data) override {
    decode(*static_cast<Message*>(data), reinterpret_cast<char*>(payload->data), payload->length);
    return true;
  }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override {
    return
        [data] { return static_cast<std::uint32_t>(encoded_size(*static_cast<Outgoing*>(data))); };
  }
  void* createData() override { return new Message; }
  void deleteData(void* data) override { delete static_cast<Message*>(data); }
  bool getKey(void*, rtps::InstanceHandle_t*, bool) override { return false; }
  bool is_bounded() const override { return bounded_; }

 private:
  const bool bounded_;
};

rtps::Locator_t loopback() {
  rtps::Locator_t locator;
  locator.kind = LOCATOR_KIND_UDPv4;
  rtps::IPLocator::setIPv4(locator, "127.0.0.1");
  locator.port = 0;
  return locator;
}

template <class Endpoint>
void fill(Endpoint& qos, Way way) {
  qos.reliability().kind = dds::RELIABLE_RELIABILITY_QOS;
  qos.durability().kind = dds::VOLATILE_DURABILITY_QOS;
  qos.history().kind = dds::KEEP_ALL_HISTORY_QOS;
  qos.resource_limits().max_samples = 0;
  qos.resource_limits().max_instances = 0;
  qos.resource_limits().max_samples_per_instance = 0;
  qos.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
  qos.data_sharing().off();
  if (way != Way::DataSharing) return;
  qos.history().kind = dds::KEEP_LAST_HISTORY_QOS;
  qos.history().depth = kSharedSamples;
  qos.resource_limits().max_samples = kSharedSamples;
  qos.resource_limits().max_instances = 1;
  qos.resource_limits().max_samples_per_instance = kSharedSamples;
  qos.endpoint().history_memory_policy = rtps::PREALLOCATED_MEMORY_MODE;
  qos.data_sharing().automatic();
}

/// Segments that hold the fragments of some mebibytes; the default's half a mebibyte loses them.
std::shared_ptr<eprosima::fastdds::rtps::SharedMemTransportDescriptor> shared_memory() {
  auto memory = std::make_shared<eprosima::fastdds::rtps::SharedMemTransportDescriptor>();
  memory->segment_size(16 << 20);
  return memory;
}

/// Others than those of calls. (Readers have no lease of liveliness, as in Skein's back end.)
template <class Endpoint>
void fill(Endpoint& qos, Delivery delivery) {
  fill(qos, Way::Plain);
  qos.history().kind = dds::KEEP_LAST_HISTORY_QOS;
  qos.history().depth = 1;
  if (delivery == Delivery::BestEffort) {
    qos.reliability().kind = dds::BEST_EFFORT_RELIABILITY_QOS;
  } else {
    qos.durability().kind = dds::TRANSIENT_LOCAL_DURABILITY_QOS;
  }
}

}  // namespace

FastddsParticipant::FastddsParticipant(std::uint32_t domain, Way way, std::uint32_t greatest_number)
    : way_(way) {
  auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  udp->interfaceWhiteList = {"127.0.0.1"};
  udp->sendBufferSize = 64 << 20;
  udp->receiveBufferSize = 4 << 20;
  udp->maxInitialPeersRange = greatest_number;
  dds::DomainParticipantQos qos;
  qos.transport().use_builtin_transports = false;
  qos.transport().user_transports.push_back(udp);
  if (way == Way::SharedMemory) qos.transport().user_transports.push_back(shared_memory());
  auto& builtin = qos.wire_protocol().builtin;
  builtin.avoid_builtin_multicast = true;
  builtin.initialPeersList.push_back(loopback());
  builtin.discovery_config.leaseDuration = Duration_t(1, 0);
  builtin.discovery_config.leaseDuration_announcementperiod = Duration_t(0, 250'000'000);
  builtin.discovery_config.initial_announcements = {5, Duration_t(0, 10'000'000)};
  participant_ = dds::DomainParticipantFactory::get_instance()->create_participant(domain, qos);
  if (participant_ == nullptr) throw Internal("no Fast DDS participant");
  dds::TypeSupport(new MessageType(way)).register_type(participant_);
  publisher_ = participant_->create_publisher(dds::PublisherQos());
  subscriber_ = participant_->create_subscriber(dds::SubscriberQos());
}

dds::Topic* FastddsParticipant::topic_of(const char* name) {
  if (dds::TopicDescription* known = participant_->lookup_topicdescription(name)) {
    return static_cast<dds::Topic*>(known);
  }
  return participant_->create_topic(name, kType, dds::TopicQos());
}

dds::DataWriter* FastddsParticipant::make(const char* topic, dds::DataWriterQos qos) {
  qos.publish_mode().kind = dds::SYNCHRONOUS_PUBLISH_MODE;
  qos.reliable_writer_qos().times.heartbeatPeriod = Duration_t(0, 100'000'000);
  qos.reliable_writer_qos().times.nackResponseDelay = Duration_t(0, 0);
  qos.reliable_writer_qos().times.nackSupressionDuration = Duration_t(0, 10'000'000);
  return publisher_->create_datawriter(topic_of(topic), qos);
}

dds::DataReader* FastddsParticipant::make(const char* topic, const dds::DataReaderQos& given,
                                          dds::DataReaderListener* listener) {
  dds::DataReaderQos qos = given;
  qos.reliable_reader_qos().times.initialAcknackDelay = Duration_t(0, 10'000'000);
  qos.reliable_reader_qos().times.heartbeatResponseDelay = Duration_t(0, 0);
  return subscriber_->create_datareader(
      topic_of(topic), qos, listener,
      listener ? dds::StatusMask::data_available() : dds::StatusMask::none());
}

dds::DataWriter* FastddsParticipant::writer(const char* topic) {
  dds::DataWriterQos qos;
  fill(qos, way_);
  return make(topic, qos);
}

dds::DataReader* FastddsParticipant::reader(const char* topic, dds::DataReaderListener* listener) {
  dds::DataReaderQos qos;
  fill(qos, way_);
  return make(topic, qos, listener);
}

dds::DataWriter* FastddsParticipant::writer(const char* topic, Delivery delivery) {
  dds::DataWriterQos qos;
  fill(qos, delivery);
  if (delivery == Delivery::LatestOfTheLiving) {
    qos.liveliness().lease_duration = Duration_t(1, 0);
    qos.liveliness().announcement_period = Duration_t(0, 400'000'000);
  }
  return make(topic, qos);
}

dds::DataReader* FastddsParticipant::reader(const char* topic, Delivery delivery,
                                            dds::DataReaderListener* listener) {
  dds::DataReaderQos qos;
  fill(qos, delivery);
  return make(topic, qos, listener);
}

}  // namespace skein::benchmarks::raw
