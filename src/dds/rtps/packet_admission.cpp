#include "packet_admission.hpp"

#include <algorithm>

namespace skein::dds {
namespace {

constexpr Admission::Verdict kTaken;

/// Whether an entity id is one of DDS's own.
bool is_of_discovery(std::uint32_t entity) { return (entity & 0xc0) == 0xc0; }

}  // namespace

std::int64_t Admission::Writer::held_up_to() const {
  if (readers.empty()) return 0;
  return std::ranges::min(readers, {}, &Reader::acknowledged).acknowledged;
}

Admission::Participant* Admission::find(const Guid& participant) {
  const auto known = participants_.find(participant);
  return known == participants_.end() ? nullptr : &known->second;
}

Admission::Writer* Admission::find(const Guid& participant, std::uint32_t writer) {
  Participant* const known = find(participant);
  if (known == nullptr) return nullptr;
  const auto found = known->writers.find(writer);
  return found == known->writers.end() ? nullptr : &found->second;
}

// ---- participants

Admission::Verdict Admission::announced(const Origin& origin) {
  Participant* known = find(origin.participant);
  if (known == nullptr) {
    Source& source = source_at(origin.source);
    if (participants_.size() >= kMaxParticipants ||
        source.participants >= kMaxParticipantsOfSource) {
      forget_unconfirmed(origin.now);
    }
    if (participants_.size() >= kMaxParticipants ||
        source.participants >= kMaxParticipantsOfSource || source.newcomers.left(origin.now) < 1) {
      return Refusal::Crowd;
    }
    source.newcomers.take(1);
    known = &participants_[origin.participant];
  }
  known->heard = origin.now;
  place(*known, origin.source);
  return kTaken;
}

bool Admission::has_announced_from(const Guid& participant, std::uint32_t source) const {
  const auto known = participants_.find(participant);
  return known != participants_.end() && std::ranges::count(known->second.sources, source) > 0;
}

void Admission::found(const Guid& participant) { participants_[participant].found = true; }

void Admission::removed(const Guid& participant) {
  const auto known = participants_.find(participant);
  if (known != participants_.end()) forget(known);
}

bool Admission::knows(const Origin& origin) {
  Participant* const known = find(origin.participant);
  if (known == nullptr) return false;
  known->heard = origin.now;
  return true;
}

// Those from which nobody has announced himself are forgotten when there are many.
Admission::Source& Admission::source_at(std::uint32_t address) {
  constexpr std::size_t kManySources = 4 * kMaxParticipants;
  const auto known = sources_.find(address);
  if (known != sources_.end()) return known->second;
  if (sources_.size() >= kManySources) {
    std::erase_if(sources_, [](const auto& each) { return each.second.participants == 0; });
  }
  return sources_[address];
}

void Admission::place(Participant& participant, std::uint32_t source) {
  constexpr std::size_t kInterfaces = 4;
  if (!std::ranges::count(participant.sources, source)) {
    if (participant.sources.size() >= kInterfaces) participant.sources.clear();
    participant.sources.push_back(source);
  }
  if (participant.placed && participant.source == source) return;
  unplace(participant);
  Source& to = source_at(source);
  ++to.participants;
  to.announced += participant.announced_size;
  participant.source = source;
  participant.placed = true;
}

void Admission::unplace(Participant& participant) {
  if (!participant.placed) return;
  Source& source = sources_[participant.source];
  --source.participants;
  source.announced -= participant.announced_size;
  participant.placed = false;
}

void Admission::forget(std::unordered_map<Guid, Participant>::iterator participant) {
  writers_ -= participant->second.writers.size();
  open_bytes_ -= participant->second.open_bytes;
  open_samples_ -= participant->second.open_samples;
  announced_ -= participant->second.announced_size;
  unplace(participant->second);
  participants_.erase(participant);
}

void Admission::forget_unconfirmed(Time now) {
  for (auto each = participants_.begin(); each != participants_.end();) {
    const auto next = std::next(each);
    if (!each->second.found && now - each->second.heard > kUnconfirmed) forget(each);
    each = next;
  }
}

// ---- sequence numbers

Admission::Verdict Admission::announce(Participant& participant, std::uint32_t entity,
                                       std::int64_t number, Time now, Writer*& found) {
  auto known = participant.writers.find(entity);
  if (known == participant.writers.end() || !known->second.heard) {
    if (number > kMaxBefore) return Refusal::Leap;
    if (known == participant.writers.end()) {
      const std::size_t left = kMaxWritersInAll - std::min(kMaxWritersInAll, writers_);
      if (participant.writers.size() >= std::min(kMaxWriters, left)) return Refusal::Room;
      known = participant.writers.emplace(entity, Writer()).first;
      ++writers_;
    }
    found = &known->second;
    found->heard = true;
    found->highest = number;
    found->advanced = now;
    return kTaken;
  }
  Writer& writer = known->second;
  found = &writer;
  if (number <= writer.highest) return kTaken;
  const auto since = std::chrono::duration_cast<std::chrono::microseconds>(now - writer.advanced);
  const std::int64_t allowance = std::min(kGreatestLeap, writer.allowance + since.count());
  const std::int64_t leap = number - writer.highest;
  if (leap > allowance) return Refusal::Leap;
  writer.highest = number;
  writer.allowance = allowance - leap;
  writer.advanced = now;
  return kTaken;
}

Admission::Verdict Admission::sample(const Origin& origin, std::uint32_t writer,
                                     std::int64_t number) {
  Participant* const sender = find(origin.participant);
  if (sender == nullptr) return Refusal::Stranger;
  Writer* found = nullptr;
  return announce(*sender, writer, number, origin.now, found);
}

// How far a writer may skip numbers now, which is paid for.
std::int64_t Admission::let_skip(Participant& participant, Writer& writer, std::int64_t up_to,
                                 Time now) {
  if (skipped_ == SkippedNumbers::Noted) return up_to;
  const std::int64_t from = std::max(writer.counted, writer.held_up_to());
  if (up_to <= from) return up_to;
  Source& source = source_at(participant.source);
  const std::int64_t wanted = up_to - from;
  const std::int64_t own = std::min(wanted, participant.numbers.left(now));
  const std::int64_t shared =
      std::min({wanted - own, source.numbers.left(now), numbers_.left(now)});
  participant.numbers.take(own);
  source.numbers.take(shared);
  numbers_.take(shared);
  return writer.counted = from + own + shared;
}

Admission::Verdict Admission::heartbeat(const Origin& origin, std::uint32_t entity,
                                        std::int64_t& first, std::int64_t& last) {
  Participant* const sender = find(origin.participant);
  if (sender == nullptr) return Refusal::Stranger;
  Writer* writer = nullptr;
  if (const auto verdict = announce(*sender, entity, last, origin.now, writer)) return verdict;
  const std::int64_t before = std::max(writer->counted, writer->held_up_to());
  const std::int64_t reached = let_skip(*sender, *writer, first - 1, origin.now);
  if (reached == first - 1) return kTaken;
  if (reached <= before) return Refusal::Leap;
  first = reached + 1;
  last = reached;
  return kTaken;
}

Admission::Verdict Admission::gap(const Origin& origin, std::uint32_t entity, std::int64_t start,
                                  std::int64_t& last) {
  Participant* const sender = find(origin.participant);
  if (sender == nullptr) return Refusal::Stranger;
  Writer* writer = nullptr;
  if (const auto verdict = announce(*sender, entity, last, origin.now, writer)) return verdict;
  if (skipped_ == SkippedNumbers::Noted) {
    last = std::min(last, start - 1 + kLongestGap);
    return kTaken;
  }
  const std::int64_t held = writer->held_up_to();
  last = std::min(last, held + (start <= held + 1 ? kLongestGap : kGapAhead));
  if (last < start) return Refusal::Leap;
  last = std::min(last, let_skip(*sender, *writer, last, origin.now));
  return last < start ? Verdict(Refusal::Leap) : kTaken;
}

// ---- readers here

void Admission::matched(const Guid& participant, std::uint32_t entity, std::uint32_t reader,
                        bool now) {
  Participant* const remote = find(participant);
  if (remote == nullptr) return;
  const auto found = remote->writers.find(entity);
  if (now) {
    if (found == remote->writers.end()) ++writers_;
    Writer& writer = found != remote->writers.end() ? found->second : remote->writers[entity];
    if (!std::ranges::count(writer.readers, reader, &Reader::entity)) {
      writer.readers.push_back({reader, 0});
    }
  } else if (found != remote->writers.end()) {
    Writer& writer = found->second;
    std::erase_if(writer.readers, [&](const Reader& each) { return each.entity == reader; });
    if (!writer.readers.empty()) return;
    for (auto& [number, sample] : writer.samples) close(*remote, sample);
    writer.samples.clear();
  }
}

void Admission::reader_gone(std::uint32_t reader) {
  for (auto& [guid, participant] : participants_) {
    for (auto& [entity, writer] : participant.writers) {
      if (std::ranges::count(writer.readers, reader, &Reader::entity) > 0) {
        matched(guid, entity, reader, false);
      }
    }
  }
}

void Admission::acknowledged(const Guid& participant, std::uint32_t entity, std::uint32_t reader,
                             std::int64_t number) {
  Writer* const writer = find(participant, entity);
  if (writer == nullptr || number < 0) return;
  const auto known = std::ranges::find(writer->readers, reader, &Reader::entity);
  if (known != writer->readers.end()) {
    known->acknowledged = number;
  } else if (is_of_discovery(entity)) {  // whose readers nobody tells of
    writer->readers.push_back({reader, number});
  }
}

// ---- fragments

Admission::Verdict Admission::fragments(const Origin& origin, std::uint32_t entity,
                                        std::int64_t number,
                                        const rtps_message::Fragments& fragments) {
  constexpr std::size_t kRemembered = 256;
  Participant* const sender = find(origin.participant);
  if (sender == nullptr) return Refusal::Stranger;
  if (fragments.size < kSmallestFragment) return Refusal::Fragment;
  if (fragments.sample_size > kLargestSample) return Refusal::Room;
  Writer* writer = find(origin.participant, entity);
  if (writer == nullptr || writer->readers.empty()) return Refusal::Unmatched;
  if (const auto verdict = announce(*sender, entity, number, origin.now, writer)) return verdict;
  const std::int64_t before = std::int64_t{fragments.first - 1} * fragments.size;
  sender->earned = std::min<std::int64_t>(
      kLargestSample, sender->earned + kAhead * std::min<std::int64_t>(
                                                    std::int64_t{fragments.count} * fragments.size,
                                                    fragments.sample_size - before));
  const auto found = writer->samples.find(number);
  const bool known = found != writer->samples.end();
  if (known && (found->second.size != fragments.sample_size ||
                found->second.fragment_size != fragments.size)) {
    return Refusal::Fragment;
  }
  if (known && found->second.given_up) return Refusal::Room;
  if (known && found->second.missing == 0) return kTaken;
  const std::uint32_t count = fragments.in_sample();
  if (!known || !found->second.open) {
    if (!begin(*sender, fragments.sample_size, origin.now)) return Refusal::Room;
    writer->samples[number] = {fragments.sample_size, fragments.size, count,
                               std::vector<bool>(count), origin.now};
    // The oldest one is forgotten that takes no room.
    if (writer->samples.size() > kRemembered) {
      const auto closed =
          std::ranges::find_if(writer->samples, [](const auto& each) { return !each.second.open; });
      if (closed != writer->samples.end()) writer->samples.erase(closed);
    }
  }
  Sample& sample = writer->samples[number];
  sample.last = origin.now;
  for (std::uint32_t i = fragments.first - 1; i < fragments.first - 1 + fragments.count; ++i) {
    if (sample.received[i]) continue;
    sample.received[i] = true;
    --sample.missing;
  }
  if (sample.missing == 0) close(*sender, sample);
  return kTaken;
}

// Pays for a sample, with what its sender has earned first.
bool Admission::begin(Participant& participant, std::uint32_t size, Time now) {
  const auto has_share = [&] {
    return participant.open_bytes + size <= kMaxBytes - std::min(kMaxBytes, open_bytes_ + size) &&
           participant.open_samples + 1 <= kMaxSamples - std::min(kMaxSamples, open_samples_ + 1);
  };
  if (!has_share() && skipped_ == SkippedNumbers::Noted) close_stale(participant, now);
  if (!has_share()) return false;
  Source& source = source_at(participant.source);
  const std::int64_t own = std::min<std::int64_t>(size, participant.earned);
  if (size - own > source.begun.left(now)) return false;
  participant.earned -= own;
  source.begun.take(size - own);
  participant.open_bytes += size;
  open_bytes_ += size;
  ++participant.open_samples;
  ++open_samples_;
  return true;
}

void Admission::close(Participant& participant, Sample& sample) {
  if (!sample.open) return;
  sample.open = false;
  sample.received = {};
  participant.open_bytes -= sample.size;
  open_bytes_ -= sample.size;
  --participant.open_samples;
  --open_samples_;
}

// For a vendor that holds no more of a sample than was received of it. Not with each packet.
void Admission::close_stale(Participant& participant, Time now) {
  if (now - participant.closed_stale < kPatience / 10) return;
  participant.closed_stale = now;
  for (auto& [entity, writer] : participant.writers) {
    for (auto& [number, sample] : writer.samples) {
      if (now - sample.last > kPatience) close(participant, sample);
    }
  }
}

std::vector<Admission::Incomplete> Admission::give_up(Time now) {
  std::vector<Incomplete> all;
  for (auto& [guid, participant] : participants_) {
    if (participant.open_samples == 0) continue;
    for (auto& [entity, writer] : participant.writers) {
      for (auto& [number, sample] : writer.samples) {
        if (!sample.open || now - sample.last <= kPatience) continue;
        sample.given_up = true;
        all.push_back({guid, entity, number});
      }
    }
  }
  return all;
}

void Admission::dropped(const Incomplete& sample) {
  Participant* const sender = find(sample.participant);
  Writer* const writer = find(sample.participant, sample.writer);
  if (writer == nullptr) return;
  const auto found = writer->samples.find(sample.number);
  if (found == writer->samples.end() || !found->second.given_up) return;
  close(*sender, found->second);
  writer->samples.erase(found);
}

}  // namespace skein::dds
