#include "admission.hpp"

#include <algorithm>

namespace skein::dds {
namespace {

constexpr Admission::Verdict kGood;

}  // namespace

std::int64_t Admission::Writer::held_up_to() const {
  if (acknowledged.empty()) return 0;
  return std::ranges::min(acknowledged, {}, &Acknowledgment::number).number;
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
    if (participants_.size() >= kMaxParticipants) forget_unconfirmed(origin.now);
    if (participants_.size() >= kMaxParticipants) return Refusal::Room;
    known = &participants_[origin.participant];
  }
  known->heard = origin.now;
  place(*known, origin.source);
  return kGood;
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

void Admission::place(Participant& participant, std::uint32_t source) {
  constexpr std::size_t kManySources = 4 * kMaxParticipants;
  if (participant.placed && participant.source == source) return;
  if (participant.placed) --sources_[participant.source].participants;
  if (sources_.size() >= kManySources) {
    std::erase_if(sources_, [](const auto& each) { return each.second.participants == 0; });
  }
  ++sources_[source].participants;
  participant.source = source;
  participant.placed = true;
}

void Admission::forget(std::unordered_map<Guid, Participant>::iterator participant) {
  if (participant->second.placed) --sources_[participant->second.source].participants;
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
  const auto known = participant.writers.find(entity);
  if (known == participant.writers.end()) {
    if (number > kMaxBefore) return Refusal::Leap;
    if (participant.writers.size() >= kMaxWriters) return Refusal::Room;
    found = &participant.writers[entity];
    found->highest = number;
    found->advanced = now;
    return kGood;
  }
  Writer& writer = known->second;
  found = &writer;
  if (number <= writer.highest) return kGood;
  const auto since = std::chrono::duration_cast<std::chrono::microseconds>(now - writer.advanced);
  const std::int64_t allowance = std::min(kGreatestLeap, writer.allowance + since.count());
  const std::int64_t leap = number - writer.highest;
  if (leap > allowance) return Refusal::Leap;
  writer.highest = number;
  writer.allowance = allowance - leap;
  writer.advanced = now;
  return kGood;
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
  Source& source = sources_[participant.source];
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
  if (reached == first - 1) return kGood;
  if (reached <= before) return Refusal::Leap;
  first = reached + 1;
  last = reached;
  return kGood;
}

Admission::Verdict Admission::gap(const Origin& origin, std::uint32_t entity, std::int64_t start,
                                  std::int64_t& last) {
  Participant* const sender = find(origin.participant);
  if (sender == nullptr) return Refusal::Stranger;
  Writer* writer = nullptr;
  if (const auto verdict = announce(*sender, entity, last, origin.now, writer)) return verdict;
  if (skipped_ == SkippedNumbers::Noted) {
    last = std::min(last, start - 1 + kLongestGap);
    return kGood;
  }
  const std::int64_t held = writer->held_up_to();
  last = std::min(last, held + (start <= held + 1 ? kLongestGap : kGapAhead));
  if (last < start) return Refusal::Leap;
  last = std::min(last, let_skip(*sender, *writer, last, origin.now));
  return last < start ? Verdict(Refusal::Leap) : kGood;
}

void Admission::acknowledged(const Guid& participant, std::uint32_t entity, std::uint32_t reader,
                             std::int64_t number) {
  constexpr std::size_t kManyReaders = 64;
  Writer* const writer = find(participant, entity);
  if (writer == nullptr || number < 0) return;
  const auto known = std::ranges::find(writer->acknowledged, reader, &Acknowledgment::reader);
  if (known != writer->acknowledged.end()) {
    known->number = number;
  } else if (writer->acknowledged.size() < kManyReaders) {
    writer->acknowledged.push_back({reader, number});
  }
}

// ---- fragments

Admission::Verdict Admission::fragments(const Origin& origin, std::uint32_t entity,
                                        std::int64_t number,
                                        const rtps_message::Fragments& fragments) {
  Participant* const sender = find(origin.participant);
  if (sender == nullptr) return Refusal::Stranger;
  Writer* writer = nullptr;
  if (const auto verdict = announce(*sender, entity, number, origin.now, writer)) return verdict;
  if (fragments.size < kSmallestFragment) return Refusal::Fragment;
  const SampleId id{origin.participant, entity, number};
  auto found = samples_.find(id);
  if (found == samples_.end()) {
    if (number <= writer->given_up) return Refusal::Room;
    if (!make_room(fragments.sample_size, origin.now)) return Refusal::Room;
    const std::uint32_t count = fragments.in_sample();
    found = samples_
                .emplace(id, Sample{fragments.sample_size, fragments.size, count,
                                    std::vector<bool>(count), origin.now})
                .first;
    order_.push_back(id);
    claimed_ += fragments.sample_size;
  }
  Sample& sample = found->second;
  if (sample.size != fragments.sample_size || sample.fragment_size != fragments.size) {
    return Refusal::Fragment;
  }
  if (sample.missing == 0) return kGood;
  sample.last = origin.now;
  for (std::uint32_t i = fragments.first - 1; i < fragments.first - 1 + fragments.count; ++i) {
    if (sample.received[i]) continue;
    sample.received[i] = true;
    --sample.missing;
  }
  if (sample.missing == 0) {
    sample.received = {};
    claimed_ -= sample.size;
  }
  return kGood;
}

bool Admission::make_room(std::uint32_t size, Time now) {
  constexpr auto kGivenUpAfter = std::chrono::seconds(5);
  constexpr int kAskedAtATime = 8;
  const auto is_room = [&] {
    return samples_.size() < kMaxSamples && claimed_ + size <= kMaxBytes;
  };
  if (size > kLargestSample) return false;
  for (int i = 0; i < kAskedAtATime && !is_room() && !order_.empty(); ++i) {
    const SampleId id = order_.front();
    order_.pop_front();
    const auto found = samples_.find(id);
    const Sample& sample = found->second;
    if (sample.missing > 0 && now - sample.last < kGivenUpAfter) {
      order_.push_back(id);
      continue;
    }
    if (sample.missing > 0) {
      claimed_ -= sample.size;
      if (Writer* const writer = find(id.participant, id.writer)) {
        writer->given_up = std::max(writer->given_up, id.number);
      }
    }
    samples_.erase(found);
  }
  return is_room();
}

}  // namespace skein::dds
