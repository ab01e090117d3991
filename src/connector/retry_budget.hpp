#pragma once

#include <algorithm>
#include <atomic>

namespace skein::connector {

/// What repeats and hedges may add to the calls of one connection: one for 16 calls, and a few from
/// the start, so that from 134 calls on they are at most a tenth. Without it, providers that are
/// too slow already would get each call twice, and stay too slow. Google's guide on site
/// reliability has such budgets (Beyer et al. 2016, "Handling overload"). Thread-safe.
class RetryBudget {
 public:
  static constexpr int kCallsPerRetry = 16;
  static constexpr int kReserve = 5;

  /// A call has begun.
  void earn() noexcept { add(1); }

  /// Whether one more repeat or hedge may be made, which then is paid for.
  bool take() noexcept {
    int before = credit_;
    while (before >= kCallsPerRetry) {
      if (credit_.compare_exchange_weak(before, before - kCallsPerRetry)) return true;
    }
    return false;
  }

  /// One is made in any case, and paid for by later calls.
  void owe() noexcept { credit_ -= kCallsPerRetry; }

  /// So many that were paid for were no additional load.
  void give_back(int count) noexcept { add(count * kCallsPerRetry); }

 private:
  static constexpr int kMost = kReserve * kCallsPerRetry;

  void add(int calls) noexcept {
    int before = credit_;
    while (before < kMost &&
           !credit_.compare_exchange_weak(before, std::min(before + calls, kMost))) {
    }
  }

  std::atomic<int> credit_{kMost};  // in calls
};

}  // namespace skein::connector
