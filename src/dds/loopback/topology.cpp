#include "topology.hpp"

#include <cstring>

namespace skein::dds::loopback {

std::shared_ptr<ParticipantCore> Topology::join(const ParticipantOptions& options) {
  auto participant = std::make_shared<ParticipantCore>();
  participant->options = options;
  std::memcpy(participant->guid.bytes.data(), "loopback", 8);
  ++last_participant_;
  std::uint8_t* number = participant->guid.bytes.data() + 8;
  for (const int shift : {24, 16, 8, 0})
    *number++ = static_cast<std::uint8_t>(last_participant_ >> shift);
  participants_.emplace(participant->guid, participant);
  return participant;
}

void Topology::leave(const Guid& participant) {
  participants_.erase(participant);
  isolated_.erase(participant);
}

void Topology::heal() {
  isolated_.clear();
  separated_.clear();
}

void Topology::pause(const Guid& participant, bool paused) {
  const auto found = participants_.find(participant);
  if (found != participants_.end()) found->second->paused = paused;
}

void Topology::kill(const Guid& participant) {
  const auto found = participants_.find(participant);
  if (found != participants_.end()) found->second->killed = true;
}

bool Topology::connected(const ParticipantCore& one, const ParticipantCore& other) const {
  if (&one == &other) return true;
  if (one.options.domain != other.options.domain || one.killed || other.killed) return false;
  return !isolated_.contains(one.guid) && !isolated_.contains(other.guid) &&
         !separated_.contains(std::minmax(one.guid, other.guid));
}

}  // namespace skein::dds::loopback
