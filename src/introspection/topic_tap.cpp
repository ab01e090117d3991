#include "topic_tap.hpp"

#include <utility>

namespace skein {

std::unique_ptr<dds::Reader> tap_topic(dds::Participant& participant, const KnownTopic& topic,
                                       std::vector<std::string> systems, TopicTap tap) {
  const inspection::TopicEndpoint& told = topic.endpoints.front().told;
  const dds::Qos qos{topic.reading_qos(),
                     told.xcdr2 ? dds::DataRepresentation::Xcdr2 : dds::DataRepresentation::Xcdr1,
                     {},
                     std::move(systems)};
  dds::ReaderListener listener;
  // Of a topic without keys a foreign writer alone sends them, and no instance ends by it.
  if (!told.keyed) tap.on_disposed = nullptr;
  listener.on_data = [on_value = std::move(tap.on_value),
                      on_disposed = std::move(tap.on_disposed)](dds::Reader& reader) {
    reader.take([&](const dds::Sample& sample) {
      const bool alive = sample.state == dds::InstanceState::Alive;
      if (const auto& tell = alive ? on_value : on_disposed) tell(sample);
    });
  };
  listener.on_matched = std::move(tap.on_matched);
  // What comes without its key's hash is taken, too.
  listener.find_key = [](std::span<const std::byte>) { return dds::KeyHash{}; };
  return participant.create_reader({topic.name, topic.type, told.keyed}, qos, std::move(listener));
}

}  // namespace skein
