#include "traffic/alerting.hpp"

#include <algorithm>

namespace reconnaissance {
namespace {

constexpr double kHysteresis_s = 5;
constexpr double kPersistence_s = 4;

}  // namespace

AlertLevel alert_without_memory(const TrafficState& own, const TrafficState& other,
                                AlertLevel present) {
  for (const AlertRule& rule : kEnRouteAlerts) {
    const double within_s = rule.level == present ? rule.kept_s : rule.raised_s;
    if (violation(own, other, rule.volume, within_s)) return rule.level;
  }
  return AlertLevel::None;
}

AlertLevel Alert::assess(const TrafficState& own, const TrafficState& other, double now_s) {
  if (!assessed_s_ || now_s - *assessed_s_ > kHysteresis_s) {
    shown_ = AlertLevel::None;
    risen_s_.reset();
    const AlertLevel first = alert_without_memory(own, other);
    last_ = {AlertLevel::None, AlertLevel::None, first, first};
  } else {
    std::rotate(last_.begin(), last_.begin() + 1, last_.end());
    last_.back() = alert_without_memory(own, other, shown_);
  }
  assessed_s_ = now_s;
  const AlertLevel level = seen_twice();
  if (level > shown_) {
    risen_s_ = now_s;
    shown_ = level;
  } else if (!risen_s_ || now_s - *risen_s_ >= kPersistence_s) {
    shown_ = level;
  }
  return shown_;
}

AlertLevel Alert::seen_twice() const {
  auto sorted = last_;
  std::sort(sorted.begin(), sorted.end());
  return sorted[sorted.size() - 2];
}

}  // namespace reconnaissance
