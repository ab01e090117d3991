#include "raw/fastdds_participant.hpp"

#include <fastdds/dds/domain/DomainParticipantFactory.hpp>

#include SKEIN_RAW_FAST_DDS  // fast_dds_2.hpp or fast_dds_3.hpp, of the release that CMake has found

namespace skein::benchmarks::raw {
namespace {

/// What data sharing reserves for each sample, and how many samples it reserves.
constexpr std::uint32_t kGreatestMessage = (1 << 20) + 64;
constexpr std::int32_t kSharedSamples = 8;

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
std::shared_ptr<transports::SharedMemTransportDescriptor> shared_memory() {
  auto memory = std::make_shared<transports::SharedMemTransportDescriptor>();
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
  auto udp = std::make_shared<transports::UDPv4TransportDescriptor>();
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
  dds::TypeSupport(new MessageType(way == Way::DataSharing, kGreatestMessage))
      .register_type(participant_);
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
  qos.reliable_writer_qos().times.*kHeartbeatPeriod = Duration_t(0, 100'000'000);
  qos.reliable_writer_qos().times.*kNackResponseDelay = Duration_t(0, 0);
  qos.reliable_writer_qos().times.*kNackSuppression = Duration_t(0, 10'000'000);
  return publisher_->create_datawriter(topic_of(topic), qos);
}

dds::DataReader* FastddsParticipant::make(const char* topic, const dds::DataReaderQos& given,
                                          dds::DataReaderListener* listener) {
  dds::DataReaderQos qos = given;
  qos.reliable_reader_qos().times.*kInitialAckNackDelay = Duration_t(0, 10'000'000);
  qos.reliable_reader_qos().times.*kHeartbeatResponseDelay = Duration_t(0, 0);
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
