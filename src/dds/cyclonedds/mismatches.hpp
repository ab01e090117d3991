#pragma once

#include <dds/dds.h>

#include <functional>
#include <mutex>
#include <set>

#include "dds/port.hpp"

namespace skein::dds::cyclonedds {

class CycloneParticipant;

/// Whom one endpoint cannot be matched with, and why. Cyclone's listener says neither who nor which
/// values, so they are looked up among all endpoints that Cyclone knows.
class Mismatches {
 public:
  enum class Side { Writer, Reader };
  using Told = std::function<void(const Incompatibility&)>;

  /// Does nothing where there is nobody to tell.
  Mismatches(CycloneParticipant& participant, Topic topic, Qos qos, Side side, Told told);

  /// From Cyclone's listener.
  void mismatched(std::uint32_t policy);

  /// A peer that Cyclone has matched, which may have another version of the type.
  void matched(const dds_builtintopic_endpoint_t& peer);

  /// Looks, and tells. Also once after creation: whatever happened before is told then.
  void update();

 private:
  void consider(const dds_builtintopic_endpoint_t& peer);

  const Topic topic_;
  const Qos qos_;
  const Side side_;
  const Told told_;
  const dds_entity_t peers_;  // reads all endpoints of the other kind
  std::mutex mutex_;
  std::set<Guid> known_;
};

}  // namespace skein::dds::cyclonedds
