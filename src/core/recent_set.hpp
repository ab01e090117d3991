#pragma once

#include <cstddef>
#include <iterator>
#include <list>
#include <unordered_map>

namespace skein {

/// The last values that were inserted, a bounded number; the oldest are forgotten first. Not
/// thread-safe.
template <class Value>
class RecentSet {
 public:
  explicit RecentSet(std::size_t most) : max_(most) {}

  /// A value that is there already becomes the newest.
  void insert(const Value& value) {
    erase(value);
    if (order_.size() >= max_) erase(Value(order_.front()));
    places_.emplace(value, order_.insert(order_.end(), value));
  }

  bool contains(const Value& value) const { return places_.contains(value); }

  /// Whether it was there.
  bool erase(const Value& value) {
    const auto found = places_.find(value);
    if (found == places_.end()) return false;
    order_.erase(found->second);
    places_.erase(found);
    return true;
  }

 private:
  const std::size_t max_;
  std::list<Value> order_;  // the oldest first
  std::unordered_map<Value, typename std::list<Value>::iterator> places_;
};

}  // namespace skein
