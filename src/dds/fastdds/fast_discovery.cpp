#include "fast_discovery.hpp"

#include "attributes.hpp"
#include "fast_identity.hpp"
#include "put_off_leases.hpp"

namespace skein::dds::fastdds {

void FastDiscovery::on_participant(Change change, const Announced& participant) {
  const bool present = change != Change::Gone;
  const Guid guid = participant.guid.participant();
  if (change == Change::Found) {
    for (const auto& locator : participant.locators.unicast) {
      transport_.pace.discovered(locator.port, std::chrono::steady_clock::now());
    }
  }
  if (present) {
    transport_.guard.found(guid);
    {
      std::lock_guard lock(mutex_);
      names_[guid] = participant.name;
    }
    silence_.follow(guid, announced_lease(participant.lease.seconds, participant.lease.nanosec),
                    std::chrono::steady_clock::now());
  } else {
    transport_.guard.removed(guid);
    {
      std::lock_guard lock(mutex_);
      names_.erase(guid);
    }
    silence_.forget(guid);
  }
  if (change == Change::Changed || !on_participant_) return;
  {
    std::lock_guard lock(mutex_);
    if (present ? !present_.insert(guid).second : present_.erase(guid) == 0) return;
  }
  events_.post([this, guid, present] { on_participant_(guid, present); });
}

void FastDiscovery::on_writer(const Guid& writer, const AnnouncedWriter* announced) {
  if (announced == nullptr) return lost(writer);
  found(writer, to_endpoint(Side::Writer, AnnouncedEndpoint(*announced)));
}

void FastDiscovery::on_reader(const Guid& reader, const AnnouncedReader* announced) {
  if (announced == nullptr) return lost(reader);
  found(reader, to_endpoint(Side::Reader, AnnouncedEndpoint(*announced)));
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
