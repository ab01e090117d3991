#include <cstring>

#include "raw/cyclonedds_participant.hpp"
#include "raw/neighbour.hpp"

namespace skein::benchmarks::raw {
namespace {

void read_announcements(dds_entity_t reader, void* census) {
  for (Message message; take(reader, message);)
    static_cast<Heard*>(census)->add(message.head.client);
}

}  // namespace

void cyclonedds_neighbour(const RawOptions& options) {
  Heard census;
  // One more: Cyclone 0.10 reports the last index as taken after taking it.
  CycloneddsParticipant participant(options.domain, options.peers);
  dds_listener_t* listener = dds_create_listener(&census);
  dds_lset_data_available(listener, read_announcements);
  const auto topic = participant.topic(kAnnouncementTopic);
  participant.reader(topic, Delivery::LatestOfTheLiving, listener);
  participant.reader(participant.topic(kLoadTopic), Delivery::Latest);
  for_each_introspection_topic([&](const std::string& name, bool reliable) {
    const auto told = participant.topic(name.c_str());
    reliable ? participant.writer(told) : participant.writer(told, Delivery::BestEffort);
  });
  participant.writer(participant.topic(kAnswersTopic));
  participant.reader(participant.topic(kQuestionsTopic));
  participant.reader(participant.topic(kRequestTopic));
  participant.writer(participant.topic(kReplyTopic));
  dds_delete_listener(listener);
  const dds_entity_t own = participant.writer(topic, Delivery::LatestOfTheLiving);
  dds_guid_t guid;
  check(dds_get_guid(own, &guid));
  const Content content(kAnnouncementBytes);
  Outgoing announcement{{}, &content};
  std::memcpy(announcement.head.client.data(), guid.v, announcement.head.client.size());
  write(own, topic.type, announcement);
  census.await(options.peers);
  run_server();
}

}  // namespace skein::benchmarks::raw
