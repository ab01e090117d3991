#include "endpoints.hpp"

#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>

#include <chrono>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <stdexcept>

using namespace eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;

namespace {

constexpr std::uint32_t kDomain = 17;

DomainParticipantQos loopback_alone() {
  DomainParticipantQos qos;
  auto transport = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  transport->interfaceWhiteList = {"127.0.0.1"};
  transport->maxInitialPeersRange = 40;
  qos.transport().use_builtin_transports = false;
  qos.transport().user_transports.push_back(transport);
  auto& builtin = qos.wire_protocol().builtin;
  builtin.avoid_builtin_multicast = true;
  builtin.discovery_config.leaseDuration_announcementperiod = {0, 250'000'000};
  rtps::Locator_t peer;
  rtps::IPLocator::setIPv4(peer, "127.0.0.1");
  builtin.initialPeersList.push_back(peer);
  return qos;
}

template <class Qos>
Qos service_qos() {
  Qos qos;
  qos.reliability().kind = RELIABLE_RELIABILITY_QOS;
  qos.durability().kind = VOLATILE_DURABILITY_QOS;
  qos.history().kind = KEEP_ALL_HISTORY_QOS;
  qos.data_sharing().off();
  return qos;
}

template <class Made>
Made* made(Made* object, const std::string& what) {
  if (!object) throw std::runtime_error("Fast DDS makes no " + what);
  return object;
}

// Cyclone refuses endpoints whose type Fast DDS describes.
TypeSupport without_description(TypeSupport type) {
  type->auto_fill_type_object(false);
  type->auto_fill_type_information(false);
  return type;
}

}  // namespace

Endpoints::Endpoints(TypeSupport written_type, const std::string& written_topic,
                     TypeSupport read_type, const std::string& read_topic)
    : participant_(made(
          DomainParticipantFactory::get_instance()->create_participant(kDomain, loopback_alone()),
          "participant")) {
  const auto topic = [this](TypeSupport type, const std::string& name) {
    without_description(type).register_type(participant_);
    return made(participant_->create_topic(name, type.get_type_name(), TOPIC_QOS_DEFAULT), name);
  };
  Publisher* publisher = made(participant_->create_publisher(PUBLISHER_QOS_DEFAULT), "publisher");
  Subscriber* subscriber =
      made(participant_->create_subscriber(SUBSCRIBER_QOS_DEFAULT), "subscriber");
  auto writer_qos = service_qos<DataWriterQos>();
  writer_qos.reliable_writer_qos().times.heartbeatPeriod = {0, 100'000'000};
  writer_ =
      made(publisher->create_datawriter(topic(written_type, written_topic), writer_qos), "writer");
  reader_ = made(
      subscriber->create_datareader(topic(read_type, read_topic), service_qos<DataReaderQos>()),
      "reader");
}

Endpoints::~Endpoints() {
  // A writer that Fast DDS 2.9 deletes with samples may count holes among them without end
  // (corrected by its pull request 4076).
  std::size_t removed;
  writer_->clear_history(&removed);
  participant_->delete_contained_entities();
  DomainParticipantFactory::get_instance()->delete_participant(participant_);
}

void Endpoints::write(void* sample) {
  if (!writer_->write(sample)) throw std::runtime_error("Fast DDS does not write the sample");
}

void Endpoints::wait_for_acknowledgments(int patience_ms) {
  writer_->wait_for_acknowledgments({patience_ms / 1000, 0});
}

bool Endpoints::take(void* sample, int patience_ms) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(patience_ms);
  while (true) {
    SampleInfo info;
    while (reader_->take_next_sample(sample, &info) == ReturnCode_t::RETCODE_OK) {
      if (info.valid_data) return true;
    }
    const auto left = std::chrono::duration<double>(end - std::chrono::steady_clock::now()).count();
    if (left <= 0) return false;
    reader_->wait_for_unread_message(eprosima::fastrtps::Duration_t(left));
  }
}
