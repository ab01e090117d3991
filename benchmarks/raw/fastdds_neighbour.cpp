#include <cstring>

#include SKEIN_RAW_FAST_DDS

#include "raw/fastdds_participant.hpp"
#include "raw/neighbour.hpp"

namespace skein::benchmarks::raw {
namespace {

class AnnouncementListener final : public dds::DataReaderListener {
 public:
  void on_data_available(dds::DataReader* reader) override {
    Message message;
    dds::SampleInfo info;
    while (reader->take_next_sample(&message, &info) == kOk) {
      if (info.valid_data) census.add(message.head.client);
    }
  }

  Heard census{};
};

}  // namespace

void fastdds_neighbour(const RawOptions& options) {
  static AnnouncementListener listener;  // Fast DDS's threads end with the process
  FastddsParticipant participant(options.domain, Way::Plain, options.peers);
  participant.reader(kAnnouncementTopic, Delivery::LatestOfTheLiving, &listener);
  participant.reader(kLoadTopic, Delivery::Latest);
  for_each_introspection_topic([&](const std::string& name, bool reliable) {
    reliable ? participant.writer(name.c_str())
             : participant.writer(name.c_str(), Delivery::BestEffort);
  });
  participant.writer(kAnswersTopic);
  participant.reader(kQuestionsTopic);
  participant.reader(kRequestTopic);
  participant.writer(kReplyTopic);
  dds::DataWriter* own = participant.writer(kAnnouncementTopic, Delivery::LatestOfTheLiving);
  const Content content(kAnnouncementBytes);
  Outgoing announcement{{}, &content};
  std::memcpy(announcement.head.client.data(), &own->guid(), announcement.head.client.size());
  own->write(&announcement);
  listener.census.await(options.peers);
  run_server();
}

}  // namespace skein::benchmarks::raw
