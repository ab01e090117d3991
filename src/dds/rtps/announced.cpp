// What participants announce: the part of Admission that counts it.
#include <algorithm>

#include "packet_admission.hpp"

namespace skein::dds {

Admission::Verdict Admission::announced(const Origin& origin, std::uint32_t entity,
                                        std::size_t size) {
  Participant* const sender = find(origin.participant);
  if (sender == nullptr) return Refusal::Stranger;
  const auto known = sender->announced.find(entity);
  const std::size_t before = known == sender->announced.end() ? 0 : known->second;
  const std::size_t now = kKeptOfEach + size;
  if (!has_room(*sender, before, now)) return Refusal::Announced;
  sender->announced[entity] = now;
  change_announced(*sender, before, now);
  return std::nullopt;
}

// It has been withdrawn and announced anew while the vendor told of the withdrawal.
void Admission::endpoint_found(const Guid& participant, std::uint32_t entity) {
  Participant* const owner = find(participant);
  if (owner == nullptr || !owner->announced.try_emplace(entity, kKeptOfEach).second) return;
  change_announced(*owner, 0, kKeptOfEach);
}

void Admission::endpoint_removed(const Guid& participant, std::uint32_t entity) {
  Participant* const owner = find(participant);
  if (owner == nullptr) return;
  if (const auto gone = owner->announced.extract(entity))
    change_announced(*owner, gone.mapped(), 0);
}

Admission::Verdict Admission::may_wait(const Origin& origin, std::uint32_t entity,
                                       std::int64_t number) {
  Participant* const sender = find(origin.participant);
  Writer* const writer = find(origin.participant, entity);
  if (writer == nullptr || skipped_ == SkippedNumbers::Noted) return std::nullopt;
  const std::int64_t held = std::max(writer->counted, writer->held_up_to());
  const std::int64_t behind = std::max<std::int64_t>(0, writer->highest - held);
  if (behind < writer->waiting) change_waiting(*sender, *writer, behind);
  if (number <= held + 1) return std::nullopt;
  if (writer->waiting >= kMaxWaiting || !has_room(*sender, 0, kKeptOfEach)) {
    return Refusal::Announced;
  }
  change_waiting(*sender, *writer, writer->waiting + 1);
  return std::nullopt;
}

bool Admission::has_room(const Participant& participant, std::size_t before,
                         std::size_t now) const {
  const auto fits = [&](std::size_t held, std::size_t most) {
    return now <= before || held - before + now <= most;
  };
  const auto source = sources_.find(participant.source);
  return fits(participant.announced_size, kMaxAnnounced) && fits(announced_, kMaxAnnouncedInAll) &&
         (source == sources_.end() || fits(source->second.announced, kMaxAnnouncedAtSource));
}

void Admission::change_waiting(Participant& participant, Writer& writer, std::int64_t now) {
  change_announced(participant, static_cast<std::size_t>(writer.waiting) * kKeptOfEach,
                   static_cast<std::size_t>(now) * kKeptOfEach);
  writer.waiting = now;
}

void Admission::change_announced(Participant& participant, std::size_t before, std::size_t now) {
  participant.announced_size += now - before;
  announced_ += now - before;
  if (participant.placed) sources_[participant.source].announced += now - before;
}

}  // namespace skein::dds
