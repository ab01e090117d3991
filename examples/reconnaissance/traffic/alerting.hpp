#pragma once

#include <array>
#include <optional>

#include "traffic/well_clear.hpp"

namespace reconnaissance {

enum class AlertLevel { None, Preventive, Corrective, Warning };

/// How long before a violation a level is raised. Once raised it lasts while a violation is within
/// the longer time.
struct AlertRule {
  AlertLevel level;
  WellClearVolume volume;
  double raised_s;
  double kept_s;
};

/// Most severe first. DO-365B en route (alerting and early alerting times in NASA DAIDALUS's
/// DO_365B_no_SUM.conf).
constexpr std::array<AlertRule, 3> kEnRouteAlerts{
    AlertRule{AlertLevel::Warning, kEnRoute, 25, 55},
    AlertRule{AlertLevel::Corrective, kEnRoute, 55, 75},
    AlertRule{AlertLevel::Preventive, kPreventive, 55, 75}};

/// The most severe level whose volume is violated in time if both fly straight on. `present` is the
/// level that is shown.
AlertLevel alert_without_memory(const TrafficState& own, const TrafficState& other,
                                AlertLevel present = AlertLevel::None);

/// Alert about one intruder. What is shown is the most severe level that two of the last four
/// assessments had (M of N). A level that has risen lasts for 4 s at least (persistence). After
/// more than 5 s without an assessment the memory is void (hysteresis), and the next assessment is
/// shown at once, as is the first. Numbers and meaning after DAIDALUS, DO_365B_no_SUM.conf.
class Alert {
 public:
  /// Times grow; call once a second.
  AlertLevel assess(const TrafficState& own, const TrafficState& other, double now_s);

 private:
  AlertLevel seen_twice() const;

  std::array<AlertLevel, 4> last_{};
  std::optional<double> assessed_s_;
  std::optional<double> risen_s_;
  AlertLevel shown_ = AlertLevel::None;
};

}  // namespace reconnaissance
