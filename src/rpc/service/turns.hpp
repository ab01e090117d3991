#pragma once

#include <algorithm>
#include <iterator>
#include <memory_resource>
#include <utility>
#include <vector>

#include "skein/detail/call_memory.hpp"

namespace skein::rpc {

/// Those who take turns. Whoever comes is last. Not thread-safe; operations take time in their
/// number.
template <class T>
class Turns {
 public:
  bool empty() const noexcept { return all_.empty(); }

  /// Null where none is like that.
  template <class Predicate>
  T* find(Predicate predicate) noexcept {
    const auto found = std::find_if(all_.begin(), all_.end(), predicate);
    return found == all_.end() ? nullptr : &*found;
  }
  template <class Predicate>
  const T* find(Predicate predicate) const noexcept {
    return const_cast<Turns&>(*this).find(predicate);
  }

  /// Last means just before the one whose turn it is.
  T& add(T item) {
    const auto added = all_.insert(all_.begin() + turn_, std::move(item));
    if (all_.size() > 1) turn_ = (turn_ + 1) % std::ssize(all_);
    return *added;
  }

  /// Whose turn it is; not while empty.
  T& present() noexcept { return all_[static_cast<std::size_t>(turn_)]; }

  /// The present one's turn is over.
  void pass() noexcept {
    if (++turn_ >= std::ssize(all_)) turn_ = 0;
  }
  /// The present one is done for good.
  void remove() noexcept {
    all_.erase(all_.begin() + turn_);
    if (turn_ >= std::ssize(all_)) turn_ = 0;
  }

 private:
  std::pmr::vector<T> all_{&call_memory()};
  std::ptrdiff_t turn_ = 0;
};

}  // namespace skein::rpc
