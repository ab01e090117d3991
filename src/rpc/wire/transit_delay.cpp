#include "transit_delay.hpp"

#include <algorithm>
#include <utility>

namespace skein::rpc {

Duration TransitDelay::excess(Duration sent, Instant arrived) {
  const Duration difference = arrived.time_since_epoch() - sent;
  if (!present_ || arrived - begun_ >= kWindow) {
    last_ = std::exchange(present_, std::nullopt);
    begun_ = arrived;
  }
  if (!present_ || difference < present_->grown(arrived)) present_ = {difference, arrived};
  Duration least = present_->grown(arrived);
  if (last_) least = std::min(least, last_->grown(arrived));
  return std::max(difference - least, Duration::zero());
}

}  // namespace skein::rpc
