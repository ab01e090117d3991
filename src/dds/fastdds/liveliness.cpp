#include "liveliness.hpp"

#include <cstring>

namespace skein::dds::fastdds {

void assert_liveliness(rtps::RTPSParticipant& participant) {
  // RTPS 9.6.3.1: the participant, the kind, and no data, in plain CDR. Fast DDS 2 itself calls it
  // a list of parameters, which Cyclone DDS 0.10.5 refuses.
  constexpr rtps::octet kEncapsulation[] = {0, 1, 0, 0};
  constexpr rtps::octet kAutomatic = 1;
  constexpr std::uint32_t kSize = sizeof kEncapsulation + 24;
  const auto [writer, history] = liveliness_writer(participant);
  rtps::InstanceHandle_t key;
  const rtps::GuidPrefix_t& prefix = participant.getGuid().guidPrefix;
  std::memcpy(&key.value[0], prefix.value, rtps::GuidPrefix_t::size);
  key.value[15] = kAutomatic;
  const std::lock_guard lock(writer->getMutex());
  rtps::CacheChange_t* const change = new_change(*writer, *history, kSize, rtps::ALIVE, key);
  if (change == nullptr) return;
  rtps::octet* const payload = change->serializedPayload.data;
  std::memset(payload, 0, kSize);
  std::memcpy(payload, kEncapsulation, sizeof kEncapsulation);
  std::memcpy(payload + sizeof kEncapsulation, &key.value[0], 16);
  change->serializedPayload.length = kSize;
  if (history->getHistorySize() > 0) history->remove_min_change();
  if (!history->add_change(change)) release_change(*writer, *history, *change);
}

}  // namespace skein::dds::fastdds
