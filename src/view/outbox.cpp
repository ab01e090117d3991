#include "view/outbox.hpp"

#include <algorithm>
#include <utility>

namespace skein::view {
namespace {

/// A small message takes this much beside its bytes.
constexpr std::size_t kOverhead = 128;

std::size_t weight(const Frame& frame) { return frame.size() + kOverhead; }

}  // namespace

bool Outbox::push(Frame message) {
  if (message_bytes_ + weight(message) > capacity_) return false;
  message_bytes_ += weight(message);
  messages_.push_back(std::move(message));
  return true;
}

void Outbox::push_sample(std::uint32_t subscription, Frame sample, Time now) {
  while (!samples_.empty() && sample_bytes_ + weight(sample) > capacity_) {
    take_sample();
    ++dropped_;
  }
  sample_bytes_ += weight(sample);
  ++waiting_[subscription];
  samples_.push_back({subscription, std::move(sample), now});
}

Frame Outbox::take_sample() {
  Sample sample = std::move(samples_.front());
  samples_.pop_front();
  sample_bytes_ -= weight(sample.frame);
  const auto waiting = waiting_.find(sample.subscription);
  if (--waiting->second == 0) waiting_.erase(waiting);
  return std::move(sample.frame);
}

void Outbox::forget(std::uint32_t subscription) {
  std::erase_if(samples_, [&](const Sample& sample) {
    if (sample.subscription != subscription) return false;
    sample_bytes_ -= weight(sample.frame);
    return true;
  });
  waiting_.erase(subscription);
}

/// The newest of a subscription stays, whatever its age, and is the next that goes.
void Outbox::drop_old(Time now) {
  while (!samples_.empty() && now - samples_.front().since > kLongestWait &&
         waiting_[samples_.front().subscription] > 1) {
    take_sample();
    ++dropped_;
  }
}

std::optional<Frame> Outbox::pop(Time now) {
  if (!messages_.empty()) {
    Frame next = std::move(messages_.front());
    messages_.pop_front();
    message_bytes_ -= weight(next);
    return next;
  }
  drop_old(now);
  if (samples_.empty()) return std::nullopt;
  return take_sample();
}

}  // namespace skein::view
