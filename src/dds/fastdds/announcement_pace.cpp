#include "announcement_pace.hpp"

#include <algorithm>

namespace skein::dds::fastdds {

using namespace rtps_message;

std::optional<std::int64_t> announcement_number(const Submessage& submessage) {
  constexpr std::size_t kNumberAt = 12;
  // A farewell has inline QoS, which says that it is one.
  if (!is_announcement(submessage) || !submessage.flag(kHasData) || submessage.flag(kInlineQos)) {
    return std::nullopt;
  }
  return get_sequence_number(submessage.body() + kNumberAt, submessage.little());
}

void AnnouncementPace::discovered(std::uint32_t port, Time now) {
  std::lock_guard lock(mutex_);
  discovered_[port] = now;
}

bool AnnouncementPace::due(std::int64_t number, const Destination& destination, Time now) {
  constexpr unsigned kFreely = 6;       // one may be lost, or come before anybody listens
  constexpr std::size_t kMany = 16384;  // who came and went
  std::lock_guard lock(mutex_);
  if (number != number_ || sent_.size() > kMany) sent_.clear();
  number_ = number;
  Sent& sent = sent_[destination];
  const auto discovered = discovered_.find(std::get<2>(destination));
  const bool awaited = discovered != discovered_.end() && discovered->second >= sent.last;
  if (sent.times >= kFreely && !awaited && now - sent.last < period_ * 3 / 4) return false;
  sent.times = std::min(sent.times + 1, kFreely);
  sent.last = now;
  return true;
}

}  // namespace skein::dds::fastdds
