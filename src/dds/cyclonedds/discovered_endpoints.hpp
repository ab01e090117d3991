#pragma once

#include <dds/dds.h>

#include <atomic>
#include <mutex>

#include "cyclone_entity.hpp"
#include "dds/port/endpoints.hpp"
#include "dds/rtps/rtps_guard.hpp"

namespace skein::dds::cyclonedds {

/// All endpoints that Cyclone tells of in its built-in topics. An endpoint is known here before it
/// is matched, and so before the first of its samples comes: Cyclone calls this listener as it
/// writes the built-in sample, on the thread that matches afterwards.
class DiscoveredEndpoints {
 public:
  /// Tells the guard, too. Not from a listener.
  DiscoveredEndpoints(dds_entity_t participant, RtpsGuard& guard);

  Endpoints& all() noexcept { return all_; }

 private:
  struct Source {
    Side side;
    Endpoints& all;
    RtpsGuard& guard;
    dds_entity_t participants = 0;  // the reader of their names
    std::mutex taking{};
    std::atomic<dds_entity_t> handle{0};  // 0 for a listener that comes before it is known
    Entity reader{};                      // goes first: its listener uses the rest
  };

  static void open(Source& source, dds_entity_t participant, dds_entity_t topic);
  static void take(Source& source);

  Endpoints all_;
  Entity participants_;
  Source writers_;
  Source readers_;
};

}  // namespace skein::dds::cyclonedds
