#include "writer_ledger.hpp"

#include <algorithm>

namespace skein::dds {

WriterLedger::Writer* WriterLedger::find(const Guid& writer) {
  const auto found = recent_.find(writer);
  if (found != recent_.end()) return &found->second;
  auto node = older_.extract(writer);
  return node ? &recent_.insert(std::move(node)).position->second : nullptr;
}

bool WriterLedger::announce(const Guid& writer, std::int64_t number, Clock::time_point now) {
  Writer* known = find(writer);
  if (known == nullptr) {
    if (number > kMaxBefore) return false;
    if (recent_.size() >= kMaxWriters / 2) {
      older_ = std::move(recent_);
      recent_.clear();
    }
    recent_[writer] = {number, kLeap, now, 0};
    return true;
  }
  if (number <= known->highest) return true;
  const auto since = std::chrono::duration_cast<std::chrono::microseconds>(now - known->advanced);
  const std::int64_t allowance = std::min(kGreatestLeap, known->allowance + since.count());
  const std::int64_t leap = number - known->highest;
  if (leap > allowance) return false;
  known->highest = number;
  known->allowance = allowance - leap;
  known->advanced = now;
  return true;
}

WriterLedger::Verdict WriterLedger::fragments(const Guid& writer, std::int64_t number,
                                              const rtps_message::Fragments& fragments,
                                              Clock::time_point now) {
  if (fragments.size < kSmallestFragment) return Verdict::Contradiction;
  const SampleId id{writer, number};
  auto found = samples_.find(id);
  if (found == samples_.end()) {
    const Writer* known = find(writer);
    if (known != nullptr && number <= known->given_up) return Verdict::NoRoom;
    if (!make_room(fragments.sample_size, now)) return Verdict::NoRoom;
    const std::uint32_t count = fragments.in_sample();
    found = samples_
                .emplace(id, Sample{fragments.sample_size, fragments.size, count,
                                    std::vector<bool>(count), now})
                .first;
    order_.push_back(id);
    claimed_ += fragments.sample_size;
  }
  Sample& sample = found->second;
  if (sample.size != fragments.sample_size || sample.fragment_size != fragments.size) {
    return Verdict::Contradiction;
  }
  if (sample.missing == 0) return Verdict::Good;
  sample.last = now;
  for (std::uint32_t i = fragments.first - 1; i < fragments.first - 1 + fragments.count; ++i) {
    if (sample.received[i]) continue;
    sample.received[i] = true;
    --sample.missing;
  }
  if (sample.missing == 0) {
    sample.received = {};
    claimed_ -= sample.size;
  }
  return Verdict::Good;
}

bool WriterLedger::make_room(std::uint32_t size, Clock::time_point now) {
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
      if (Writer* writer = find(id.writer)) {
        writer->given_up = std::max(writer->given_up, id.number);
      }
    }
    samples_.erase(found);
  }
  return is_room();
}

}  // namespace skein::dds
