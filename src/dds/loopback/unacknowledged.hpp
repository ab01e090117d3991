#pragma once

#include <map>
#include <memory_resource>
#include <optional>
#include <utility>
#include <vector>

#include "cores.hpp"

namespace skein::dds::loopback {

/// The samples that a reliable writer keeps for one reader: until they and all before have arrived.
class Unacknowledged {
 public:
  struct Entry {
    MessagePtr message;
    bool arrived = false;
    std::uint32_t in_flight = 0;
    std::uint32_t attempts = 0;
  };

  /// With a `depth`, a newer sample of the instance takes the oldest one's place.
  void add(const MessagePtr& message, std::optional<std::uint32_t> depth) {
    std::size_t same = 0;
    for (auto entry = entries_.rbegin(); depth && entry != entries_.rend(); ++entry) {
      if (entry->second.message->key == message->key && ++same == *depth) {
        entries_.erase(entry->first);
        break;
      }
    }
    entries_.try_emplace(message->sequence, Entry{message});
  }

  void sent(std::uint64_t sequence, std::uint32_t attempt, std::uint32_t delayed_copies) {
    const auto entry = entries_.find(sequence);
    if (entry == entries_.end()) return;
    entry->second.attempts = attempt;
    entry->second.in_flight += delayed_copies;
  }

  /// A copy is no longer in flight, whether the reader gets it or not.
  void landed(std::uint64_t sequence) {
    const auto entry = entries_.find(sequence);
    if (entry != entries_.end() && entry->second.in_flight > 0) --entry->second.in_flight;
  }

  /// The reader has the sample. Returns whether the writer still kept it.
  bool arrived(std::uint64_t sequence) {
    const auto entry = entries_.find(sequence);
    if (entry != entries_.end()) entry->second.arrived = true;
    return entry != entries_.end();
  }

  /// The oldest sample, no longer kept; nothing if it has not arrived.
  MessagePtr pop_arrived() {
    const auto first = entries_.begin();
    if (first == entries_.end() || !first->second.arrived) return nullptr;
    MessagePtr message = std::move(first->second.message);
    entries_.erase(first);
    return message;
  }

  /// Those that neither arrived nor are in flight.
  std::vector<Entry> lost() const {
    std::vector<Entry> lost;
    for (const auto& [sequence, entry] : entries_) {
      if (!entry.arrived && entry.in_flight == 0) lost.push_back(entry);
    }
    return lost;
  }

  void clear() { entries_.clear(); }
  const auto& entries() const noexcept { return entries_; }

 private:
  std::pmr::map<std::uint64_t, Entry> entries_{&call_memory()};  // by sequence
};

}  // namespace skein::dds::loopback
