#include "liveliness.hpp"

#include <fastdds/rtps/builtin/BuiltinProtocols.h>
#include <fastdds/rtps/builtin/discovery/participant/PDP.h>
#include <fastdds/rtps/builtin/liveliness/WLP.h>
#include <fastdds/rtps/history/WriterHistory.h>
#include <fastdds/rtps/participant/RTPSParticipant.h>
#include <fastdds/rtps/writer/StatefulWriter.h>

#include <cstring>

namespace skein::dds::fastdds {
namespace {

namespace rtps = eprosima::fastrtps::rtps;

rtps::BuiltinProtocols* builtin_protocols(rtps::WLP& liveliness);

// They are private, and lead to the only way to the lock. An explicit instantiation may name a
// private member ([temp.spec]/6).
template <auto kMember>
struct PrivateMember {
  friend rtps::BuiltinProtocols* builtin_protocols(rtps::WLP& liveliness) {
    return liveliness.*kMember;
  }
};
template struct PrivateMember<&rtps::WLP::mp_builtinProtocols>;

}  // namespace

void assert_liveliness(rtps::RTPSParticipant& participant) {
  // RTPS 9.6.3.1, as Fast DDS writes it: the participant, the kind, and no data.
  constexpr rtps::octet kEncapsulation[] = {0, 3, 0, 0};
  constexpr rtps::octet kAutomatic = 1;
  constexpr std::uint32_t kSize = sizeof kEncapsulation + 24;
  rtps::WLP& liveliness = *participant.wlp();
  rtps::StatefulWriter& writer = *liveliness.builtin_writer();
  rtps::WriterHistory& history = *liveliness.builtin_writer_history();
  rtps::InstanceHandle_t key;
  const rtps::GuidPrefix_t& prefix = participant.getGuid().guidPrefix;
  std::memcpy(&key.value[0], prefix.value, rtps::GuidPrefix_t::size);
  key.value[15] = kAutomatic;
  const std::lock_guard lock(writer.getMutex());
  rtps::CacheChange_t* const change = writer.new_change([] { return kSize; }, rtps::ALIVE, key);
  if (change == nullptr) return;
  rtps::octet* const payload = change->serializedPayload.data;
  std::memset(payload, 0, kSize);
  std::memcpy(payload, kEncapsulation, sizeof kEncapsulation);
  std::memcpy(payload + sizeof kEncapsulation, &key.value[0], 16);
  change->serializedPayload.length = kSize;
  if (history.getHistorySize() > 0) history.remove_min_change();
  if (!history.add_change(change)) writer.release_change(change);
}

std::recursive_mutex& discovery_mutex(rtps::RTPSParticipant& participant) {
  return *builtin_protocols(*participant.wlp())->mp_PDP->getMutex();
}

}  // namespace skein::dds::fastdds
