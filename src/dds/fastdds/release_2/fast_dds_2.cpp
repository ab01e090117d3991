#include <fastdds/rtps/builtin/liveliness/WLP.h>
#include <fastdds/rtps/writer/StatefulWriter.h>
#include <fastrtps/attributes/TopicAttributes.h>
#include <fastrtps/xmlparser/XMLProfileManager.h>

#include "dds/fastdds/fast_dds.hpp"

// Fast DDS's own, exported but in no header.
namespace eprosima::fastrtps::rtps {
class RTPSDomainImpl {
 public:
  static std::shared_ptr<RTPSDomainImpl> get_instance();
};
}  // namespace eprosima::fastrtps::rtps
namespace eprosima::fastdds::dds::detail {
struct LogResources;
std::shared_ptr<LogResources> get_log_resources();
}  // namespace eprosima::fastdds::dds::detail

namespace skein::dds::fastdds {
namespace {

eprosima::fastrtps::TopicAttributes topic_attributes(const Topic& topic) {
  eprosima::fastrtps::TopicAttributes attributes(topic.name.c_str(), topic.type_name.c_str(),
                                                 topic.keyed ? rtps::WITH_KEY : rtps::NO_KEY);
  // Cyclone refuses endpoints whose type Fast DDS describes (PID 75).
  attributes.auto_fill_type_object = false;
  attributes.auto_fill_type_information = false;
  return attributes;
}

}  // namespace

void leave_out_services(rtps::RTPSParticipantAttributes&) {}  // none is on

bool make_known(rtps::RTPSParticipant& participant, rtps::RTPSWriter& writer, const Topic& topic,
                const WriterQos& qos) {
  return participant.registerWriter(&writer, topic_attributes(topic), qos);
}

bool make_known(rtps::RTPSParticipant& participant, rtps::RTPSReader& reader, const Topic& topic,
                const ReaderQos& qos) {
  return participant.registerReader(&reader, topic_attributes(topic), qos);
}

rtps::CacheChange_t* new_change(rtps::RTPSWriter& writer, rtps::WriterHistory&, std::uint32_t size,
                                rtps::ChangeKind_t kind, const rtps::InstanceHandle_t& key) {
  return writer.new_change([size] { return size; }, kind, key);
}

void release_change(rtps::RTPSWriter& writer, rtps::WriterHistory&, rtps::CacheChange_t& change) {
  writer.release_change(&change);
}

void send_heartbeat(rtps::RTPSWriter& writer, bool liveliness) {
  constexpr bool kFinal = false;
  static_cast<rtps::StatefulWriter&>(writer).send_periodic_heartbeat(kFinal, liveliness);
}

std::pair<rtps::RTPSWriter*, rtps::WriterHistory*> liveliness_writer(
    rtps::RTPSParticipant& participant) {
  return {participant.wlp()->builtin_writer(), participant.wlp()->builtin_writer_history()};
}

// `used`: a check for leaks looks for these pointers, which nobody reads.
void keep_static_objects() {
  [[gnu::used]] static const auto* const domain =
      new auto(eprosima::fastrtps::rtps::RTPSDomainImpl::get_instance());
  [[gnu::used]] static const auto* const log =
      new auto(eprosima::fastdds::dds::detail::get_log_resources());
}

void turn_off_intraprocess_delivery() {
  eprosima::fastrtps::LibrarySettingsAttributes settings;
  settings.intraprocess_delivery = eprosima::fastrtps::INTRAPROCESS_OFF;
  eprosima::fastrtps::xmlparser::XMLProfileManager::library_settings(settings);
}

}  // namespace skein::dds::fastdds
