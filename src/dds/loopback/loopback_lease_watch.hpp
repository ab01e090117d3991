#pragma once

#include "matching.hpp"

namespace skein::dds::loopback {

/// Which participants hear and know each other: follows the topology, and forgets a participant
/// after its lease.
class LoopbackLeaseWatch {
 public:
  LoopbackLeaseWatch(HubState& state, Matching& matching, Transfers& transfers)
      : state_(state), matching_(matching), transfers_(transfers) {}

  /// Follows each change of the topology. A paused observer notices nothing until it resumes.
  void update_presence();
  /// The goodbye reaches participants that hear this one; the others wait for the lease.
  void say_goodbye(const Guid& participant);

 private:
  void hear(ParticipantCore& observer, const std::shared_ptr<ParticipantCore>& observed,
            View& view);
  void lose_sound(const ParticipantCore& observer, const ParticipantCore& observed, View& view);
  void expire_liveliness(const MatchId& id, std::uint64_t generation);
  bool still_silent(const Guid& observer, const Guid& observed, std::uint64_t generation);
  void forget(ParticipantCore& observer, const Guid& observed);
  void tell_presence(const ParticipantCore& observer, const Guid& observed, bool present);

  HubState& state_;
  Matching& matching_;
  Transfers& transfers_;
};

}  // namespace skein::dds::loopback
