#include "planning/link_watch.hpp"

namespace reconnaissance {

void LinkWatch::heard(double now_s) {
  state(now_s);
  if (now_s - heard_s_ > kGap_s) heard_since_s_ = now_s;
  heard_s_ = now_s;
}

Link LinkWatch::state(double now_s) {
  const double silence = silence_s(now_s);
  if (silence >= kLost_s) lost_ = true;
  if (lost_ && silence <= kGap_s && heard_s_ - heard_since_s_ >= kRecovered_s) lost_ = false;
  if (lost_) return Link::Lost;
  return silence >= kDegraded_s ? Link::Degraded : Link::Connected;
}

OrderVerdict OrderGate::judge(const GroundOrderStamp& order, double now_s) {
  if (order.sequence <= executed_) return OrderVerdict::Repeated;
  if (now_s > order.issued_s + order.lifespan_s) return OrderVerdict::Expired;
  if (now_s < order.issued_s - kClockDifference_s) return OrderVerdict::NotYetIssued;
  executed_ = order.sequence;
  return OrderVerdict::Execute;
}

}  // namespace reconnaissance
