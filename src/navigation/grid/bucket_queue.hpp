#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace skein::navigation::grid {

/// What waits to be expanded, ordered by estimate in steps of 2^shift; within a step, the latest
/// comes first, which is mostly the one that is nearest to the goal. Estimates never fall below the
/// step that was taken last (the heuristic is consistent). Keeps its memory.
class BucketQueue {
 public:
  struct Entry {
    std::uint32_t estimate;
    std::uint32_t cost;
    std::uint32_t node;
  };

  explicit BucketQueue(int shift) : shift_(shift) {}

  /// Empties it; no estimate will be below `least`.
  void reset(std::uint32_t least) {
    least_ = least;
    current_ = 0;
    heads_.clear();
    entries_.clear();
  }

  void push(const Entry& entry) {
    const std::size_t bucket = (entry.estimate - least_) >> shift_;
    if (bucket >= heads_.size()) heads_.resize(bucket + 1, kNone);
    entries_.push_back({entry, heads_[bucket]});
    heads_[bucket] = static_cast<std::uint32_t>(entries_.size() - 1);
  }

  /// Nothing that is left has a lower estimate.
  std::uint32_t least_left() const {
    return least_ + static_cast<std::uint32_t>(current_ << shift_);
  }

  /// False where it is empty.
  bool pop(Entry& entry) {
    while (current_ < heads_.size() && heads_[current_] == kNone) ++current_;
    if (current_ == heads_.size()) return false;
    const Linked& first = entries_[heads_[current_]];
    entry = first.entry;
    heads_[current_] = first.next;
    return true;
  }

 private:
  static constexpr std::uint32_t kNone = UINT32_MAX;
  struct Linked {
    Entry entry;
    std::uint32_t next;
  };

  int shift_;
  std::uint32_t least_ = 0;
  std::size_t current_ = 0;
  std::vector<std::uint32_t> heads_;
  std::vector<Linked> entries_;
};

}  // namespace skein::navigation::grid
