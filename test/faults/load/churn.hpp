#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "dds/port/port.hpp"
#include "skein/error.hpp"

namespace skein::test {

constexpr std::uint32_t kChurnDomain = 61;

/// How long something lives or stands still, which is what the churn varies.
inline void let_live(std::chrono::milliseconds length) { std::this_thread::sleep_for(length); }

inline std::unique_ptr<dds::Participant> churn_participant(dds::Vendor& vendor,
                                                           std::chrono::milliseconds lease) {
  dds::ParticipantOptions options;
  options.domain = kChurnDomain;
  options.name = "churn";
  options.lease = lease;
  options.network.max_participants = 40;
  options.on_participant = [](const Guid&, bool) {};
  return vendor.create_participant(options);
}

/// The topics of the churn: reliable, best effort, watched for liveliness, and kept for late
/// joiners.
struct ChurnTopic {
  dds::Topic topic;
  dds::Qos qos;

  static ChurnTopic any(std::mt19937& random) {
    const unsigned kind = random() % 4;
    ChurnTopic chosen{{"churn_" + std::to_string(kind), "Churn", kind == 3}, {}};
    if (kind == 1) chosen.qos.reliable = false;
    if (kind == 2) chosen.qos.liveliness_lease = std::chrono::milliseconds(200);
    if (kind == 3) {
      chosen.qos.transient_local = true;
      chosen.qos.history_depth = 1;
    }
    return chosen;
  }
};

inline std::unique_ptr<dds::Reader> churn_reader(dds::Participant& participant,
                                                 const ChurnTopic& of,
                                                 std::atomic<std::uint64_t>& received) {
  dds::ReaderListener listener;
  listener.on_data = [&received](dds::Reader& reader) {
    reader.take([&](const dds::Sample&) { ++received; });
  };
  listener.on_matched = [](const Guid&, bool) {};
  listener.on_liveliness = [](const Guid&, bool) {};
  listener.on_incompatible = [](const dds::Incompatibility&) {};
  return participant.create_reader(of.topic, of.qos, std::move(listener));
}

inline std::unique_ptr<dds::Writer> churn_writer(dds::Participant& participant,
                                                 const ChurnTopic& of) {
  dds::WriterListener listener;
  listener.on_matched = [](const Guid&, bool) {};
  return participant.create_writer(of.topic, of.qos, std::move(listener));
}

/// Mostly a small sample, sometimes one of many fragments. It may find no room: readers that were
/// stopped acknowledge nothing.
inline void churn_write(dds::Writer& writer, const ChurnTopic& of, std::mt19937& random) {
  std::vector<std::byte> sample(random() % 10 == 0 ? 150'000 : 100);
  sample[1] = std::byte{1};
  dds::KeyHash key;
  if (of.topic.keyed) key.bytes[0] = static_cast<std::uint8_t>(random() % 4);
  try {
    writer.write(sample, key);
  } catch (const Overloaded&) {
  }
}

}  // namespace skein::test
