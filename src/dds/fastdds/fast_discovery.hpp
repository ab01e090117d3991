#pragma once

#include <functional>
#include <map>
#include <mutex>
#include <set>
#include <string>

#include "dds/port/endpoints.hpp"
#include "dds/port/port.hpp"
#include "fast_silence.hpp"

namespace skein::dds::fastdds {

/// Hears from Fast DDS of other participants and their endpoints, and passes this on: to the guard,
/// to the watch over leases, to own endpoints, and to the user.
class FastDiscovery final : public ParticipantListener {
 public:
  /// `events` may end before it, but after the last call of Fast DDS's.
  FastDiscovery(const ParticipantOptions& options, StartupTransportDescriptor::State& transport,
                FastSilence& silence, EventThread& events)
      : on_participant_(options.on_participant),
        transport_(transport),
        silence_(silence),
        events_(events) {}

  Endpoints& endpoints() noexcept { return endpoints_; }

 private:
  void on_participant(Change change, const Announced& participant) override;
  void on_writer(const Guid& writer, const AnnouncedWriter* found) override;
  void on_reader(const Guid& reader, const AnnouncedReader* found) override;
  void found(const Guid& guid, Endpoint endpoint);
  void lost(const Guid& endpoint);

  const std::function<void(const Guid&, bool)> on_participant_;
  StartupTransportDescriptor::State& transport_;
  FastSilence& silence_;
  EventThread& events_;
  Endpoints endpoints_;
  std::mutex mutex_;
  std::map<Guid, std::string> names_;  // of participants that are present
  std::set<Guid> present_;             // as the user was told
};

}  // namespace skein::dds::fastdds
