#pragma once

#include <algorithm>
#include <map>
#include <memory>
#include <set>

#include "cores.hpp"

namespace skein::dds::loopback {

/// The participants of the network, and which of them reach each other.
class Topology {
 public:
  std::shared_ptr<ParticipantCore> join(const ParticipantOptions& options);
  void leave(const Guid& participant);

  void isolate(const Guid& participant) { isolated_.insert(participant); }
  void separate(const Guid& one, const Guid& other) { separated_.insert(std::minmax(one, other)); }
  void heal();
  void pause(const Guid& participant, bool paused);
  void kill(const Guid& participant);

  bool connected(const ParticipantCore& one, const ParticipantCore& other) const;
  const auto& participants() const noexcept { return participants_; }

 private:
  std::uint32_t last_participant_ = 0;
  std::map<Guid, std::shared_ptr<ParticipantCore>> participants_;
  std::set<Guid> isolated_;
  std::set<std::pair<Guid, Guid>> separated_;
};

}  // namespace skein::dds::loopback
