#pragma once

#include <mutex>
#include <vector>

namespace skein::test {

/// What a callback was given, for a test that waits for it on another thread.
template <class T>
class Heard {
 public:
  auto callback() {
    return [this](const T& value) {
      std::lock_guard lock(mutex_);
      values_.push_back(value);
    };
  }
  std::vector<T> values() const {
    std::lock_guard lock(mutex_);
    return values_;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<T> values_;
};

}  // namespace skein::test
