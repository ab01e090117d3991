#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <unordered_map>
#include <vector>

#include "largest_sample.hpp"
#include "rtps_message.hpp"
#include "skein/guid.hpp"

namespace skein::dds {

/// What remote writers have announced so far, and so what they may say next. Vendors count through
/// ranges of sequence numbers one by one, and take memory for a fragmented sample when its first
/// fragment comes. Holds a bounded number of writers and samples. Not thread-safe.
class WriterLedger {
 public:
  using Clock = std::chrono::steady_clock;

  /// A writer that is new here, as to a late joiner, may have written so many samples.
  static constexpr std::int64_t kMaxBefore = std::int64_t{1} << 32;
  /// Afterwards it may be ahead of what was heard of it by this, and by one for each microsecond
  /// since, up to the second number.
  static constexpr std::int64_t kLeap = std::int64_t{1} << 20;
  static constexpr std::int64_t kGreatestLeap = std::int64_t{1} << 30;
  static constexpr std::size_t kMaxWriters = 16384;

  /// Of one sample that comes in fragments, of all such that are not complete, and how many.
  static constexpr std::uint32_t kLargestSample = dds::kLargestSample;
  static constexpr std::uint64_t kMaxBytes = std::uint64_t{1} << 30;
  static constexpr std::size_t kMaxSamples = 4096;
  /// RTPS asks for 1024. Fast DDS keeps a list in the fragments that are missing, which smaller
  /// ones than 8 bytes would break.
  static constexpr std::uint16_t kSmallestFragment = 256;

  /// The writer says that its sample `number` exists, or existed. Whether that may be.
  bool announce(const Guid& writer, std::int64_t number, Clock::time_point now);

  enum class Verdict { Good, Contradiction, NoRoom };

  /// Fragments of the sample `number` came. All must agree on its size and theirs. Where there is
  /// no room, samples give way that are complete, or of which nothing came for 5 s; fragments of
  /// the latter are refused from then on.
  Verdict fragments(const Guid& writer, std::int64_t number,
                    const rtps_message::Fragments& fragments, Clock::time_point now);

 private:
  struct Writer {
    std::int64_t highest = 0;
    std::int64_t allowance = kLeap;
    Clock::time_point advanced;
    std::int64_t given_up = 0;  // fragmented samples up to here, unless known
  };
  struct SampleId {
    Guid writer;
    std::int64_t number;
    bool operator==(const SampleId&) const = default;
  };
  struct Hash {
    std::size_t operator()(const SampleId& id) const noexcept {
      return std::hash<Guid>()(id.writer) +
             static_cast<std::size_t>(id.number) * 0x9E3779B97F4A7C15;
    }
  };
  struct Sample {
    std::uint32_t size;
    std::uint16_t fragment_size;
    std::uint32_t missing;
    std::vector<bool> received;
    Clock::time_point last;
  };

  Writer* find(const Guid& writer);
  bool make_room(std::uint32_t size, Clock::time_point now);

  // Who is heard of moves to the first; when that is half of all, it becomes the second.
  std::unordered_map<Guid, Writer> recent_;
  std::unordered_map<Guid, Writer> older_;
  std::unordered_map<SampleId, Sample, Hash> samples_;
  std::deque<SampleId> order_;  // of samples_, to be asked to give way
  std::uint64_t claimed_ = 0;   // bytes of those not complete
};

}  // namespace skein::dds
