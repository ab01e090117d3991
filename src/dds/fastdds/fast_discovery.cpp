#include "fast_discovery.hpp"

#include <fastdds/rtps/participant/ParticipantDiscoveryInfo.h>

#include "attributes.hpp"
#include "fast_identity.hpp"
#include "put_off_leases.hpp"

namespace skein::dds::fastdds {

void FastDiscovery::onParticipantDiscovery(rtps::RTPSParticipant*,
                                           rtps::ParticipantDiscoveryInfo&& info) {
  using Info = rtps::ParticipantDiscoveryInfo;
  const bool present =
      info.status == Info::DISCOVERED_PARTICIPANT || info.status == Info::CHANGED_QOS_PARTICIPANT;
  const Guid guid = to_guid(info.info.m_guid).participant();
  if (info.status == Info::DISCOVERED_PARTICIPANT) {
    for (const auto& locator : info.info.metatraffic_locators.unicast) {
      transport_.pace.discovered(locator.port, std::chrono::steady_clock::now());
    }
  }
  if (present) {
    transport_.guard.found(guid);
    {
      std::lock_guard lock(mutex_);
      names_[guid] = info.info.m_participantName.to_string();
    }
    const auto& lease = info.info.m_leaseDuration;
    silence_.follow(guid, announced_lease(lease.seconds, lease.nanosec),
                    std::chrono::steady_clock::now());
  } else {
    transport_.guard.removed(guid);
    {
      std::lock_guard lock(mutex_);
      names_.erase(guid);
    }
    silence_.forget(guid);
  }
  if (info.status == Info::CHANGED_QOS_PARTICIPANT || !on_participant_) return;
  {
    std::lock_guard lock(mutex_);
    if (present ? !present_.insert(guid).second : present_.erase(guid) == 0) return;
  }
  events_.post([this, guid, present] { on_participant_(guid, present); });
}

void FastDiscovery::onWriterDiscovery(rtps::RTPSParticipant*, rtps::WriterDiscoveryInfo&& info) {
  const Guid guid = to_guid(info.info.guid());
  if (info.status == rtps::WriterDiscoveryInfo::REMOVED_WRITER) return lost(guid);
  found(guid, to_endpoint(info.info));
}

void FastDiscovery::onReaderDiscovery(rtps::RTPSParticipant*, rtps::ReaderDiscoveryInfo&& info) {
  const Guid guid = to_guid(info.info.guid());
  if (info.status == rtps::ReaderDiscoveryInfo::REMOVED_READER) return lost(guid);
  found(guid, to_endpoint(info.info));
}

void FastDiscovery::found(const Guid& guid, Endpoint endpoint) {
  transport_.guard.endpoint_found(guid);
  {
    std::lock_guard lock(mutex_);
    const auto name = names_.find(guid.participant());
    if (name != names_.end()) endpoint.participant = name->second;
  }
  endpoints_.found(guid, std::move(endpoint));
}

void FastDiscovery::lost(const Guid& endpoint) {
  transport_.guard.endpoint_removed(endpoint);
  endpoints_.lost(endpoint);
}

}  // namespace skein::dds::fastdds
