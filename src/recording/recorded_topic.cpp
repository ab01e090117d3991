#include "recording/recorded_topic.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "introspection/topic_tap.hpp"

namespace skein::recording {

void RecordedTopic::Heard::note(std::size_t reader, const Guid& writer, bool matched) {
  std::lock_guard lock(mutex_);
  auto& readers = readers_[writer];
  if (matched) {
    readers.insert(reader);
  } else {
    readers.erase(reader);
  }
  if (readers.empty()) readers_.erase(writer);
}

// A value may come before its writer is known to be matched.
void RecordedTopic::Heard::take(std::size_t reader, const dds::Sample& sample) {
  {
    std::lock_guard lock(mutex_);
    const auto heard = readers_.find(sample.writer);
    if (heard != readers_.end() && *heard->second.begin() < reader) return;
  }
  consumer_(sample);
}

void RecordedTopic::follow(dds::Participant& participant, const KnownTopic& topic) {
  const TopicQos qos = topic.reading_qos();
  std::set<std::string>& known = systems_[{qos.reliable, qos.transient_local, qos.exclusive}];
  std::vector<std::string> added;
  std::ranges::set_difference(topic.systems(), known, std::back_inserter(added));
  if (added.empty()) return;
  const std::size_t number = readers_.size();
  const auto take = [number, heard = heard_](const dds::Sample& sample) {
    heard->take(number, sample);
  };
  const auto note = [number, heard = heard_](const Guid& writer, bool matched) {
    heard->note(number, writer, matched);
  };
  readers_.push_back(tap_topic(participant, topic, added, {take, note, take}));
  known.insert(added.begin(), added.end());
}

}  // namespace skein::recording
