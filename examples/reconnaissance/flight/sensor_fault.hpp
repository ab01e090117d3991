#pragma once

#include <cmath>
#include <deque>
#include <optional>
#include <utility>

#include "random.hpp"

namespace reconnaissance {

/// How a sensor may fail: the words of PX4's failure command (`failure <component> <kind>`,
/// MAV_CMD_INJECT_FAILURE, enum FAILURE_TYPE of MAVLink).
enum class SensorFailure { None, Off, Stuck, Garbage, Wrong, Slow, Delayed, Intermittent };

/// When these failures strike, and how hard.
struct FailureExtent {
  double slow_period_s = 1;
  double delay_s = 0.5;
  double silent_share = 0.5;  ///< Of an intermittent sensor's measurements, that do not come.
};

/// A stream of measurements through a sensor that fails. `garbage` makes a measurement that has
/// nothing to do with the true one, `wrong` falsifies one.
template <class T>
class FailingSensor {
 public:
  explicit FailingSensor(const FailureExtent& extent = {}) : extent_(extent) {}

  /// What the sensor says, `seconds` after the measurement before; nothing where it is silent.
  template <class Garbage, class Wrong>
  std::optional<T> pass(const T& truth, SensorFailure failure, double seconds, Random& random,
                        const Garbage& garbage, const Wrong& wrong) {
    remember(truth, seconds);
    if (failure == SensorFailure::None) last_ = truth;
    since_last_s_ += seconds;
    switch (failure) {
      case SensorFailure::Off:
        return std::nullopt;
      case SensorFailure::Stuck:
        if (!last_) last_ = truth;
        return last_;
      case SensorFailure::Garbage:
        return garbage(random);
      case SensorFailure::Wrong:
        return wrong(truth);
      case SensorFailure::Slow:
        if (!last_ || since_last_s_ >= extent_.slow_period_s) {
          last_ = truth;
          since_last_s_ = 0;
        }
        return last_;
      case SensorFailure::Delayed:
        return past_.front().second;
      case SensorFailure::Intermittent:
        if (random.happens(extent_.silent_share)) return std::nullopt;
        return truth;
      case SensorFailure::None:
        break;
    }
    return truth;
  }

 private:
  /// Keeps what a delayed sensor will say.
  void remember(const T& truth, double seconds) {
    constexpr double kRounding_s = 1e-9;
    for (auto& [age_s, measurement] : past_) age_s += seconds;
    past_.emplace_back(0, truth);
    while (past_.size() > 1 && past_[1].first >= extent_.delay_s - kRounding_s) past_.pop_front();
  }

  FailureExtent extent_;
  std::deque<std::pair<double, T>> past_;  // with its age
  std::optional<T> last_;
  double since_last_s_ = 0;
};

}  // namespace reconnaissance
