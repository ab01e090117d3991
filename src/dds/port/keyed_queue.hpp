#pragma once

#include <cstdint>
#include <deque>
#include <memory_resource>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "skein/detail/call_memory.hpp"
#include "skein/guid.hpp"

namespace skein::dds {

/// First in, first out, with at most `depth` items of each key: one more replaces the key's oldest.
/// And at most `capacity` in all, where that is not 0: one more replaces the oldest of all. Without
/// a depth it costs no more than a deque.
template <class Item>
class KeyedQueue {
 public:
  explicit KeyedQueue(std::optional<std::uint32_t> depth, std::size_t capacity = 0)
      : depth_(depth), capacity_(capacity) {}

  /// Whether an item was replaced.
  bool push(const Guid& key, Item item) {
    const std::size_t before = size_;
    make_room(key);
    const bool replaced = size_ < before;
    if (depth_) places_[key].push_back(first_ + entries_.size());
    entries_.push_back({key, std::move(item)});
    ++size_;
    if (entries_.size() > 2 * size_ + 64) compact();
    return replaced;
  }

  /// The oldest item, or nothing.
  std::optional<Item> pop() {
    while (!entries_.empty()) {
      Entry entry = std::move(entries_.front());
      entries_.pop_front();
      ++first_;
      if (!entry.item) continue;
      --size_;
      if (depth_) forget_first_place(entry.key);
      return std::move(entry.item);
    }
    return std::nullopt;
  }

  void erase(const Guid& key) {
    for (Entry& entry : entries_) {
      if (entry.item && entry.key == key) {
        entry.item.reset();
        --size_;
      }
    }
    places_.erase(key);
  }

  template <class Visit>
  void for_each(Visit&& visit) const {
    for (const Entry& entry : entries_) {
      if (entry.item) visit(*entry.item);
    }
  }

  std::size_t size() const noexcept { return size_; }
  bool empty() const noexcept { return size_ == 0; }

 private:
  struct Entry {
    Guid key;
    std::optional<Item> item;
  };

  void make_room(const Guid& key) {
    if (depth_) {
      const auto found = places_.find(key);
      if (found != places_.end() && found->second.size() >= *depth_) {
        entries_[found->second.front() - first_].item.reset();
        found->second.erase(found->second.begin());
        --size_;
        return;
      }
    }
    if (capacity_ > 0 && size_ >= capacity_) pop();
  }

  void forget_first_place(const Guid& key) {
    const auto found = places_.find(key);
    found->second.erase(found->second.begin());
    if (found->second.empty()) places_.erase(found);
  }

  /// Removes the holes that replaced items left behind.
  void compact() {
    std::pmr::deque<Entry> kept{&call_memory()};
    first_ = 0;
    places_.clear();
    for (Entry& entry : entries_) {
      if (!entry.item) continue;
      if (depth_) places_[entry.key].push_back(kept.size());
      kept.push_back(std::move(entry));
    }
    entries_ = std::move(kept);
  }

  std::optional<std::uint32_t> depth_;
  std::size_t capacity_;
  std::pmr::deque<Entry> entries_{&call_memory()};
  std::uint64_t first_ = 0;  // the number of entries_.front()
  std::size_t size_ = 0;
  std::unordered_map<Guid, std::vector<std::uint64_t>> places_;
};

}  // namespace skein::dds
