#pragma once

#include <cstdint>

namespace reconnaissance {

enum class Link { Connected, Degraded, Lost };

/// Judges a datalink by when something was heard of the ground. Degraded after 10 s of silence,
/// lost after 30 s; a lost link is connected again once it has been heard for 3 s without a gap of
/// more than 2 s, so that single messages that come through do not end a contingency. In mission
/// time.
class LinkWatch {
 public:
  static constexpr double kDegraded_s = 10;
  static constexpr double kLost_s = 30;
  static constexpr double kRecovered_s = 3;
  static constexpr double kGap_s = 2;

  explicit LinkWatch(double now_s) : heard_since_s_(now_s), heard_s_(now_s) {}

  void heard(double now_s);
  Link state(double now_s);
  double silence_s(double now_s) const { return now_s - heard_s_; }

 private:
  double heard_since_s_;  ///< Without a gap.
  double heard_s_;
  bool lost_ = false;
};

struct GroundOrderStamp {
  std::uint64_t sequence = 0;  ///< Grows with each order of the station.
  double issued_s = 0;
  double lifespan_s = 5;
};

enum class OrderVerdict { Execute, Expired, Repeated, NotYetIssued };

/// Decides which ground orders are executed: each once, in order, and none after its lifespan, so
/// that what waited in a link that was lost does nothing when it is found again.
class OrderGate {
 public:
  OrderVerdict judge(const GroundOrderStamp& order, double now_s);

 private:
  /// How far the clocks of both sides may differ.
  static constexpr double kClockDifference_s = 1;
  std::uint64_t executed_ = 0;
};

}  // namespace reconnaissance
