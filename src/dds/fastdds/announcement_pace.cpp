#include "announcement_pace.hpp"

#include <algorithm>

#include "../rtps_message.hpp"

namespace skein::dds::fastdds {

using namespace rtps_message;

std::optional<std::int64_t> announcement_number(const unsigned char* message, std::size_t size) {
  constexpr std::size_t kNumberAt = 12;
  std::optional<std::int64_t> number;
  auto* unchanged = const_cast<unsigned char*>(message);
  for_each_submessage(unchanged, size, [&](const Submessage& submessage) {
    // A farewell has inline QoS, which says that it is one.
    if (is_announcement(submessage) && submessage.flag(kHasData) && !submessage.flag(kInlineQos)) {
      number = get_sequence_number(submessage.body() + kNumberAt, submessage.little());
    }
  });
  return number;
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
