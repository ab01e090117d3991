#pragma once

#include <memory>

#include "dds/port/port.hpp"
#include "dds/rtps/rtps_guard.hpp"

struct ddsi_domaingv;
struct ddsi_tran_conn;

namespace skein::dds::cyclonedds {

/// Puts a guard between Cyclone's sockets and its parser. Cyclone 0.10 has no public hook for that,
/// but its installed headers show that each connection reads by a pointer to a function: that one
/// is replaced. Construct it with the domain's internals; destroy it when the domain is gone.
class PacketGuard {
 public:
  /// Throws Internal where the internals do not look as those of 0.10 do.
  PacketGuard(ddsi_domaingv& domain, const ParticipantOptions& options);
  ~PacketGuard();
  PacketGuard(const PacketGuard&) = delete;
  PacketGuard& operator=(const PacketGuard&) = delete;

  RtpsGuard& guard() const noexcept { return *guard_; }

 private:
  const std::shared_ptr<RtpsGuard> guard_;
  std::vector<ddsi_tran_conn*> guarded_;
};

}  // namespace skein::dds::cyclonedds
