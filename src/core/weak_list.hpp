#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace skein {

/// Weak references to objects, of which most end while they are listed: references to ended ones go
/// whenever the list has doubled. Not thread-safe.
template <class T>
class WeakList {
 public:
  using List = std::vector<std::weak_ptr<T>>;

  void push(std::weak_ptr<T> added) {
    push(std::move(added), [](const std::weak_ptr<T>& each) { return each.expired(); });
  }
  /// `is_over` also says so of objects that have ended and are still referred to.
  template <class IsOver>
  void push(std::weak_ptr<T> added, const IsOver& is_over) {
    if (list_.size() >= look_at_) {
      std::erase_if(list_, is_over);
      look_at_ = std::max(kLeast, 2 * list_.size());
    }
    list_.push_back(std::move(added));
  }

  const List& all() const noexcept { return list_; }
  List take_all() { return std::exchange(list_, {}); }

 private:
  static constexpr std::size_t kLeast = 16;

  List list_;  // some have ended since the last look
  std::size_t look_at_ = kLeast;
};

}  // namespace skein
